#pragma once
#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "common/protocol/spot.hpp"

namespace liloc {

/// As what a client's clouds travel: as it wants to, or else as something that the servers in sight read.
/// Servers tell what they read once a second; a request goes to all of them. Not thread-safe.
class CodecChoice {
 public:
  using Time = std::chrono::steady_clock::time_point;

  explicit CodecChoice(CloudCodec wanted) : wanted_(wanted) {}
  /// A server has told what it reads; nothing stands for all codes.
  void heard(const std::string& server_id, const std::vector<CloudCodec>& reads, Time now);
  /// What the `followed` server reads and as many others as possible; the wanted code before others. Servers
  /// that have been silent for 5 s do not count. The wanted code where no server reads any that this client
  /// writes.
  [[nodiscard]] CloudCodec choose(const std::string& followed, Time now) const;

 private:
  struct Server {
    std::vector<CloudCodec> reads;
    Time heard;
  };
  CloudCodec wanted_;
  std::map<std::string, Server> servers_;  ///< by id, a few
};

}  // namespace liloc
