#include "common/wire/server_link.hpp"

#include <atomic>
#include <map>
#include <mutex>
#include <optional>
#include <set>
#include <shared_mutex>

#include "common/base/ids.hpp"
#include "common/base/log.hpp"
#include "common/wire/convert.hpp"
#include "common/wire/convert_spot.hpp"
#include "common/wire/topics.hpp"
#include "common/wire/typed.hpp"

namespace liloc::wire {
namespace {

/// The client whose partition a writer is in; none unless it is in exactly one partition robots/<valid id>.
std::optional<std::string> client_of(std::int32_t reader, dds_instance_handle_t publication) {
  auto* endpoint = dds_get_matched_publication_data(reader, publication);
  if (endpoint == nullptr) return std::nullopt;
  std::optional<std::string> client;
  std::uint32_t count = 0;
  char** partitions = nullptr;
  if (dds_qget_partition(endpoint->qos, &count, &partitions)) {
    const std::string_view prefix = kClientPrefix;
    if (count == 1 && std::string_view(partitions[0]).starts_with(prefix))
      if (auto id = valid_id(std::string_view(partitions[0]).substr(prefix.size()), "partition")) client = *id;
    for (std::uint32_t i = 0; i < count; ++i) dds_free(partitions[i]);
    dds_free(partitions);
  }
  dds_builtintopic_free_endpoint(endpoint);
  return client;
}

struct Client {
  Entity publisher, writer;
  std::set<dds_instance_handle_t> publications;
};

}  // namespace

struct ServerLink::Impl {
  void take_request(const liloc_msg_SpotRequest& message, const dds_sample_info_t& info);
  void refresh_matches();
  void admit(dds_instance_handle_t publication);
  void dismiss(dds_instance_handle_t publication);
  [[nodiscard]] Result<Client> make_client(const std::string& client_id) const;

  ServerLinkOptions options;
  ServerCallbacks callbacks;
  std::int32_t participant = 0, reader = 0;  // the dispatcher owns the reader
  Entity subscriber;
  std::atomic<bool> closed = false;
  std::map<dds_instance_handle_t, std::string> bound;  // publication -> client id; of the dispatcher's thread
  std::set<dds_instance_handle_t> strangers;           // matched, but bound to nobody
  mutable std::shared_mutex mutex;                     // guards clients: workers reply while matches change
  std::map<std::string, Client> clients;
};

Result<Client> ServerLink::Impl::make_client(const std::string& client_id) const {
  Client client;
  const Qos partition = partition_qos(client_partition(client_id));
  auto publisher =
      checked(dds_create_publisher(participant, partition.get(), nullptr), "publisher of " + client_id);
  if (!publisher) return tl::unexpected(publisher.error());
  auto writer = make_writer<liloc_msg_SpotReply>(participant, publisher->handle(), kReplyTopic, kept_qos(8));
  if (!writer) return tl::unexpected(writer.error());
  client.publisher = std::move(*publisher);
  client.writer = std::move(*writer);
  return client;
}

void ServerLink::Impl::admit(dds_instance_handle_t publication) {
  const auto id = client_of(reader, publication);
  if (!id) {
    strangers.insert(publication);
    log::warning("a writer of {} is not in one partition robots/<id>; it is not served", kRequestTopic);
    return;
  }
  bool joined = false;
  {
    const std::unique_lock lock(mutex);
    auto known = clients.find(*id);
    if (known == clients.end()) {
      if (clients.size() >= options.max_clients) {
        strangers.insert(publication);
        log::warning("client {} is not served: {} clients are the limit; raise max_clients", *id,
                     clients.size());
        return;
      }
      auto client = make_client(*id);
      if (!client) {
        strangers.insert(publication);
        log::error("client {} is not served: {}", *id, client.error().message);
        return;
      }
      known = clients.emplace(*id, std::move(*client)).first;
      joined = true;
    }
    known->second.publications.insert(publication);
  }
  bound[publication] = *id;
  if (joined && callbacks.on_join) callbacks.on_join(*id);
}

void ServerLink::Impl::dismiss(dds_instance_handle_t publication) {
  if (callbacks.on_gone) callbacks.on_gone(publication);
  const auto node = bound.extract(publication);
  if (!node) return;
  {
    const std::unique_lock lock(mutex);
    const auto client = clients.find(node.mapped());
    client->second.publications.erase(publication);
    if (!client->second.publications.empty()) return;
    clients.erase(client);
  }
  if (callbacks.on_leave) callbacks.on_leave(node.mapped());
}

void ServerLink::Impl::refresh_matches() {
  dds_subscription_matched_status_t status{};
  dds_get_subscription_matched_status(reader, &status);  // resets it, so that the next change shows
  std::vector<dds_instance_handle_t> handles(64);
  for (;;) {
    const auto count = dds_get_matched_publications(reader, handles.data(), handles.size());
    if (count < 0 || closed) return;
    const bool complete = static_cast<std::size_t>(count) <= handles.size();
    handles.resize(static_cast<std::size_t>(count));
    if (complete) break;
  }
  const std::set<dds_instance_handle_t> now(handles.begin(), handles.end());
  std::vector<dds_instance_handle_t> gone;
  for (const auto& [handle, id] : bound)
    if (!now.contains(handle)) gone.push_back(handle);
  for (const auto handle : gone) dismiss(handle);
  if (!gone.empty()) strangers.clear();  // there may be room now
  std::erase_if(strangers, [&](auto handle) { return !now.contains(handle); });
  for (const auto handle : now)
    if (!bound.contains(handle) && !strangers.contains(handle)) admit(handle);
}

void ServerLink::Impl::take_request(const liloc_msg_SpotRequest& message, const dds_sample_info_t& info) {
  if (closed) return;
  if (!bound.contains(info.publication_handle) && !strangers.contains(info.publication_handle))
    refresh_matches();
  const auto sender = bound.find(info.publication_handle);
  if (sender == bound.end()) return;  // a stranger, or gone already: there is no way to answer
  Arrival arrival;
  arrival.at = std::chrono::steady_clock::now();
  arrival.from = {sender->second, info.publication_handle, message.session};
  arrival.request.client_id = sender->second;
  arrival.request.seq = message.seq;
  arrival.request.stamp_ns = message.stamp_ns;
  arrival.request.odom_segment = message.odom_segment;
  if (message.protocol_version != kProtocolVersion) {
    arrival.problem = Reason::protocol_version;
    arrival.text = fmt::format("request speaks version {}, this server {}; update the older one",
                               message.protocol_version, kProtocolVersion);
  } else if (const std::string claimed = text_of(message.client_id); claimed != sender->second) {
    arrival.problem = Reason::identity;
    arrival.text = fmt::format("client_id is {}, the sender is {}", claimed, sender->second);
  } else if (auto request = from_wire(message)) {
    arrival.request = std::move(*request);
  } else {
    arrival.problem = Reason::bad_request;
    arrival.text = request.error().message;
  }
  callbacks.on_request(std::move(arrival));
}

ServerLink::ServerLink(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}
ServerLink::~ServerLink() {
  impl_->closed = true;
}

Result<std::unique_ptr<ServerLink>> ServerLink::create(Dispatcher& dispatcher, ServerLinkOptions options,
                                                       ServerCallbacks callbacks) {
  if (const auto id = valid_id(options.server_id, "server_id"); !id) return tl::unexpected(id.error());
  auto impl = std::make_shared<Impl>();
  impl->options = std::move(options);
  impl->callbacks = std::move(callbacks);
  impl->participant = dispatcher.participant().handle();
  const Qos partition = partition_qos(client_partition("*"));
  auto subscriber = checked(dds_create_subscriber(impl->participant, partition.get(), nullptr), "subscriber");
  if (!subscriber) return tl::unexpected(subscriber.error());
  // All clients share one instance: a key would let a stranger fill the table of instances.
  auto reader = make_reader<liloc_msg_SpotRequest>(impl->participant, subscriber->handle(), kRequestTopic,
                                                   reliable_qos(1024));
  if (!reader) return tl::unexpected(reader.error());
  impl->reader = reader->handle();
  impl->subscriber = std::move(*subscriber);
  dds_set_status_mask(impl->reader, DDS_SUBSCRIPTION_MATCHED_STATUS);
  auto condition = checked(dds_create_readcondition(impl->reader, DDS_ANY_STATE), "read condition");
  if (!condition) return tl::unexpected(condition.error());
  const auto condition_handle = condition->handle();
  std::vector<Entity> owned;
  owned.push_back(std::move(*condition));
  owned.push_back(std::move(*reader));
  const std::function<void(const liloc_msg_SpotRequest&, const dds_sample_info_t&)> take =
      [impl](const liloc_msg_SpotRequest& message, const dds_sample_info_t& info) {
        impl->take_request(message, info);
      };
  // Matches first: a client is known before its first request is taken.
  for (const auto& attached : {dispatcher.attach(impl->reader, {}, [impl] { impl->refresh_matches(); }),
                               dispatcher.attach(condition_handle, std::move(owned), [impl, take] {
                                 take_each<liloc_msg_SpotRequest>(impl->reader, take);
                               })})
    if (!attached) return tl::unexpected(attached.error());
  return std::unique_ptr<ServerLink>(new ServerLink(std::move(impl)));
}

Status ServerLink::reply(const Sender& to, SpotReply reply) {
  reply.server_id = impl_->options.server_id;
  reply.client_id = to.client_id;
  const auto message = to_wire(reply, to.session);
  const std::shared_lock lock(impl_->mutex);
  const auto client = impl_->clients.find(to.client_id);
  if (client == impl_->clients.end()) return fail("client {} has left", to.client_id);
  return check(dds_write(client->second.writer.handle(), &message), "write of a reply to " + to.client_id);
}

std::size_t ServerLink::clients() const {
  const std::shared_lock lock(impl_->mutex);
  return impl_->clients.size();
}

}  // namespace liloc::wire
