#include "common/wire/spots/client_link.hpp"

#include <algorithm>
#include <atomic>
#include <random>

#include "common/base/ids.hpp"
#include "common/base/log.hpp"
#include "common/wire/dds/topics.hpp"
#include "common/wire/dds/typed.hpp"
#include "common/wire/spots/convert_spot.hpp"
#include "common/wire/spots/namesake.hpp"

namespace liloc::wire {

struct ClientLink::Impl {
  void take_reply(const liloc_msg_SpotReply& message);
  void report_match();
  /// Servers that are matched in both directions: now, and since the start.
  struct Matches {
    std::uint32_t current = 0, total = 0;
  };
  [[nodiscard]] Matches matches() const;

  std::string client_id;
  std::uint64_t session = 0;
  ClientCallbacks callbacks;
  std::atomic<bool> closed = false;
  bool reported = false;    // of the dispatcher's thread, as are the next two
  std::uint32_t found = 0;  // servers so far, counted by both directions
  Namesake namesake;
  Entity publisher, subscriber, writer;
  std::int32_t reader = 0, participant = 0;  // the dispatcher owns the reader
  std::atomic<std::uint32_t> announced = 0;
};

namespace {

std::uint64_t random_session() {
  std::random_device device;
  return static_cast<std::uint64_t>(device()) << 32 | device();
}

}  // namespace

ClientLink::Impl::Matches ClientLink::Impl::matches() const {
  dds_publication_matched_status_t readers{};
  dds_subscription_matched_status_t writers{};
  if (dds_get_publication_matched_status(writer.handle(), &readers) != DDS_RETCODE_OK ||
      dds_get_subscription_matched_status(reader, &writers) != DDS_RETCODE_OK)
    return {};
  return {std::min(readers.current_count, writers.current_count),
          std::min(readers.total_count, writers.total_count)};
}

void ClientLink::Impl::report_match() {
  const Matches now = matches();  // reading the status also resets it
  const bool there = now.current > 0;
  const bool changed = there != std::exchange(reported, there);
  const bool more = now.total > std::exchange(found, now.total);
  if (closed) return;
  if (changed && callbacks.on_server) callbacks.on_server(there);
  if (more && callbacks.on_server_found) callbacks.on_server_found();
}

void ClientLink::Impl::take_reply(const liloc_msg_SpotReply& message) {
  if (closed) return;
  if (message.session != session) {  // an earlier run of this client, or another device
    const bool lives = namesake.lives(message.session, message.seq, std::chrono::steady_clock::now());
    if (lives && callbacks.on_namesake) callbacks.on_namesake();
    return;
  }
  auto reply = message.protocol_version == kProtocolVersion
                   ? from_wire(message)
                   : Result<SpotReply>(fail("server {} speaks version {}, this client {}; update the older one",
                                            message.server_id, message.protocol_version, kProtocolVersion));
  if (reply && reply->client_id != client_id) reply = fail("reply is for client {}", reply->client_id);
  if (!reply && callbacks.on_bad_reply) callbacks.on_bad_reply(reply.error().message);
  if (reply && callbacks.on_reply) callbacks.on_reply(std::move(*reply));
}

ClientLink::ClientLink(std::shared_ptr<Impl> impl) : impl_(std::move(impl)) {}
ClientLink::~ClientLink() {
  impl_->closed = true;
}

Result<std::unique_ptr<ClientLink>> ClientLink::create(Dispatcher& dispatcher, const std::string& client_id,
                                                       ClientCallbacks callbacks, std::uint64_t session) {
  const auto id = valid_id(client_id, "client_id");
  if (!id) return tl::unexpected(id.error());
  auto impl = std::make_shared<Impl>();
  impl->client_id = *id;
  impl->participant = dispatcher.participant().handle();
  impl->session = session != 0 ? session : random_session();
  impl->callbacks = std::move(callbacks);
  const auto participant = dispatcher.participant().handle();
  const Qos partition = partition_qos(client_partition(*id));
  auto publisher = checked(dds_create_publisher(participant, partition.get(), nullptr), "publisher");
  if (!publisher) return tl::unexpected(publisher.error());
  auto subscriber = checked(dds_create_subscriber(participant, partition.get(), nullptr), "subscriber");
  if (!subscriber) return tl::unexpected(subscriber.error());
  auto writer =
      make_writer<liloc_msg_SpotRequest>(participant, publisher->handle(), kRequestTopic, reliable_qos(8));
  if (!writer) return tl::unexpected(writer.error());
  auto reader = make_reader<liloc_msg_SpotReply>(participant, subscriber->handle(), kReplyTopic, kept_qos(16));
  if (!reader) return tl::unexpected(reader.error());
  impl->reader = reader->handle();
  impl->publisher = std::move(*publisher);
  impl->subscriber = std::move(*subscriber);
  impl->writer = std::move(*writer);

  // A reader shows both: its data by a read condition, its matches by its status.
  dds_set_status_mask(impl->reader, DDS_SUBSCRIPTION_MATCHED_STATUS);
  dds_set_status_mask(impl->writer.handle(), DDS_PUBLICATION_MATCHED_STATUS);
  auto condition = checked(dds_create_readcondition(impl->reader, DDS_ANY_STATE), "read condition");
  if (!condition) return tl::unexpected(condition.error());
  const auto condition_handle = condition->handle();
  std::vector<Entity> owned;
  owned.push_back(std::move(*condition));
  owned.push_back(std::move(*reader));
  const std::function<void(const liloc_msg_SpotReply&, const dds_sample_info_t&)> take =
      [impl](const liloc_msg_SpotReply& message, const dds_sample_info_t&) { impl->take_reply(message); };
  const auto report = [impl] { impl->report_match(); };
  for (const auto& attached :
       {dispatcher.attach(condition_handle, std::move(owned),
                          [impl, take] { take_each<liloc_msg_SpotReply>(impl->reader, take); }),
        dispatcher.attach(impl->reader, {}, report), dispatcher.attach(impl->writer.handle(), {}, report)})
    if (!attached) return tl::unexpected(attached.error());
  return std::unique_ptr<ClientLink>(new ClientLink(std::move(impl)));
}

std::uint64_t ClientLink::session() const {
  return impl_->session;
}

bool ClientLink::server_matched() const {
  return impl_->matches().current > 0;
}

void ClientLink::announce() {
  // What of a participant's QoS may change is its user data, and a change is told to all peers at once.
  const std::uint32_t count = ++impl_->announced;
  const Qos qos = make_qos();
  dds_qset_userdata(qos.get(), &count, sizeof count);
  if (const Status told = check(dds_set_qos(impl_->participant, qos.get()), "announcement"); !told)
    log::debug("{}", told.error().message);
}

Status ClientLink::send(const SpotRequest& request) {
  if (request.client_id != impl_->client_id)
    return fail("request is of client {}, this link is {}'s", request.client_id, impl_->client_id);
  if (!server_matched()) return fail("no server in sight; the request {} was not sent", request.seq);
  const auto sample = to_wire(request, impl_->session);
  if (!sample) return tl::unexpected(sample.error());
  return check(dds_write(impl_->writer.handle(), &sample->message), "write of a request");
}

}  // namespace liloc::wire
