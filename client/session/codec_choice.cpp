#include "client/session/codec_choice.hpp"

#include <algorithm>

namespace liloc {
namespace {

constexpr auto kSilence = std::chrono::seconds(5);  // five statuses missed
constexpr std::size_t kMostServers = 16;            // ids come from the network
constexpr int kFollowed = 1000;                     // weighs more than all others

}  // namespace

void CodecChoice::heard(const std::string& server_id, const std::vector<CloudCodec>& reads, Time now) {
  std::erase_if(servers_, [now](const auto& server) { return now - server.second.heard > kSilence; });
  if (!servers_.contains(server_id) && servers_.size() >= kMostServers) return;
  servers_[server_id] = {reads, now};
}

CloudCodec CodecChoice::choose(const std::string& followed, Time now) const {
  const auto readers = [&](CloudCodec codec) {
    int sum = 0;
    for (const auto& [id, server] : servers_)
      if (now - server.heard <= kSilence &&
          (server.reads.empty() || std::ranges::find(server.reads, codec) != server.reads.end()))
        sum += id == followed ? kFollowed : 1;
    return sum;
  };
  CloudCodec best = wanted_;
  for (const CloudCodec codec : kCloudCodecs)
    if (readers(codec) > readers(best)) best = codec;
  return best;
}

}  // namespace liloc
