#include "common/wire/spots/server_link.hpp"

#include <algorithm>
#include <atomic>
#include <map>
#include <optional>
#include <set>

#include "common/base/ids.hpp"
#include "common/base/line_limit.hpp"
#include "common/base/log.hpp"
#include "common/wire/dds/convert.hpp"
#include "common/wire/dds/topics.hpp"
#include "common/wire/dds/typed.hpp"
#include "common/wire/spots/convert_spot.hpp"
#include "common/wire/spots/reply_writers.hpp"

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

}  // namespace

struct ServerLink::Impl {
  Impl(std::int32_t participant, ServerLinkOptions o, ServerCallbacks c)
      : options(std::move(o)), callbacks(std::move(c)), writers(participant, options.max_clients) {}

  void take_request(const liloc_msg_SpotRequest& message, const dds_sample_info_t& info);
  void refresh_matches();
  void admit(dds_instance_handle_t publication);
  void dismiss(dds_instance_handle_t publication);

  const ServerLinkOptions options;
  const ServerCallbacks callbacks;
  ReplyWriters writers;
  std::int32_t reader = 0;  // the dispatcher owns it
  Entity subscriber;
  std::atomic<bool> closed = false;
  std::map<dds_instance_handle_t, std::string> bound;  // publication -> client id; of the dispatcher's thread
  std::set<dds_instance_handle_t> strangers;           // matched, but bound to nobody
  LineLimit stranger_lines;                            // of the dispatcher's thread, as the next
  SourceLimit unserved_lines;
};

void ServerLink::Impl::admit(dds_instance_handle_t publication) {
  const auto id = client_of(reader, publication);
  if (!id) {
    strangers.insert(publication);
    if (const auto held = stranger_lines.pass(std::chrono::steady_clock::now()))
      log::warning("a writer of {} is not in one partition robots/<id>; it is not served{}", kRequestTopic,
                   held_back(*held));
    return;
  }
  const auto joined = writers.open(*id);
  if (!joined) {
    strangers.insert(publication);
    if (const auto held = unserved_lines.pass(*id, std::chrono::steady_clock::now()))
      log::warning("client {} is not served: {}{}", *id, joined.error().message, held_back(*held));
    return;
  }
  bound[publication] = *id;
  if (*joined && callbacks.on_join) callbacks.on_join(*id);
}

void ServerLink::Impl::dismiss(dds_instance_handle_t publication) {
  if (callbacks.on_gone) callbacks.on_gone(publication);
  const auto node = bound.extract(publication);
  if (!node) return;
  const std::string& id = node.mapped();
  if (std::ranges::any_of(bound, [&](const auto& other) { return other.second == id; })) return;
  writers.close(id);
  if (callbacks.on_leave) callbacks.on_leave(id);
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
  const auto participant = dispatcher.participant().handle();
  auto impl = std::make_shared<Impl>(participant, std::move(options), std::move(callbacks));
  const Qos partition = partition_qos(client_partition("*"));
  auto subscriber = checked(dds_create_subscriber(participant, partition.get(), nullptr), "subscriber");
  if (!subscriber) return tl::unexpected(subscriber.error());
  // All clients share one instance: a key would let a stranger fill the table of instances.
  auto reader =
      make_reader<liloc_msg_SpotRequest>(participant, subscriber->handle(), kRequestTopic, reliable_qos(1024));
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
  return impl_->writers.write(to.client_id, to_wire(reply, to.session));
}

std::size_t ServerLink::clients() const {
  return impl_->writers.clients();
}

}  // namespace liloc::wire
