#include "common/wire/spots/reply_writers.hpp"

#include <mutex>

#include "common/wire/dds/topics.hpp"
#include "common/wire/dds/typed.hpp"

namespace liloc::wire {

Result<ReplyWriters::Ends> ReplyWriters::make(const std::string& client_id) const {
  const Qos partition = partition_qos(client_partition(client_id));
  auto publisher =
      checked(dds_create_publisher(participant_, partition.get(), nullptr), "publisher of " + client_id);
  if (!publisher) return tl::unexpected(publisher.error());
  auto writer = make_writer<liloc_msg_SpotReply>(participant_, publisher->handle(), kReplyTopic, kept_qos(8));
  if (!writer) return tl::unexpected(writer.error());
  return Ends{std::move(*publisher), std::move(*writer)};
}

Result<bool> ReplyWriters::open(const std::string& client_id) {
  const std::unique_lock lock(mutex_);
  if (clients_.contains(client_id)) return false;
  if (clients_.size() >= most_) return fail("{} clients are the limit; raise max_clients", clients_.size());
  auto ends = make(client_id);
  if (!ends) return tl::unexpected(ends.error());
  clients_.emplace(client_id, std::move(*ends));
  return true;
}

void ReplyWriters::close(const std::string& client_id) {
  const std::unique_lock lock(mutex_);
  clients_.erase(client_id);
}

Status ReplyWriters::write(const std::string& client_id, const liloc_msg_SpotReply& message) const {
  const std::shared_lock lock(mutex_);
  const auto client = clients_.find(client_id);
  if (client == clients_.end()) return fail("client {} has left", client_id);
  return check(dds_write(client->second.writer.handle(), &message), "write of a reply to " + client_id);
}

std::size_t ReplyWriters::clients() const {
  const std::shared_lock lock(mutex_);
  return clients_.size();
}

}  // namespace liloc::wire
