#include "common/wire/spots/status.hpp"

#include "common/wire/dds/topics.hpp"
#include "common/wire/dds/typed.hpp"
#include "common/wire/spots/convert_status.hpp"

namespace liloc::wire {

Result<StatusPublisher> StatusPublisher::create(const Participant& participant) {
  const Qos partition = partition_qos(kStatusPartition);
  auto publisher = checked(dds_create_publisher(participant.handle(), partition.get(), nullptr), "publisher");
  if (!publisher) return tl::unexpected(publisher.error());
  auto writer =
      make_writer<liloc_msg_ServerStatus>(participant.handle(), publisher->handle(), kStatusTopic, kept_qos(1));
  if (!writer) return tl::unexpected(writer.error());
  std::vector<Entity> entities;
  entities.push_back(std::move(*writer));
  entities.push_back(std::move(*publisher));
  return StatusPublisher(std::move(entities));
}

Status StatusPublisher::publish(const ServerStatus& status) const {
  const auto sample = to_wire(status);
  return check(dds_write(entities_.front().handle(), &sample.message), "write of the status");
}

Status subscribe_status(Dispatcher& dispatcher, std::function<void(Result<ServerStatus>)> handler) {
  const auto participant = dispatcher.participant().handle();
  const Qos partition = partition_qos(kStatusPartition);
  auto subscriber = checked(dds_create_subscriber(participant, partition.get(), nullptr), "subscriber");
  if (!subscriber) return tl::unexpected(subscriber.error());
  return subscribe<liloc_msg_ServerStatus>(
      dispatcher, std::move(*subscriber), kStatusTopic, kept_qos(1),
      [handler = std::move(handler)](const auto& message, const auto&) { handler(from_wire(message)); });
}

}  // namespace liloc::wire
