#pragma once
#include "common/protocol/spot.hpp"

namespace liloc {

/// Which server's answers count where several answer each request, a server and its standby: one is followed
/// until it fails to answer, or to verify, what another does. Two requests decide, so that the slower of two
/// good servers is not left for being slow. Not thread-safe.
class ServerChoice {
 public:
  /// To be asked of each reply as it comes; true where it counts.
  [[nodiscard]] bool takes(const SpotReply& reply);
  /// By its server_id; empty before the first reply.
  [[nodiscard]] const std::string& followed() const { return followed_; }

 private:
  std::string followed_;
  std::uint64_t answered_seq_ = 0, verified_seq_ = 0;  ///< newest of the followed server
};

}  // namespace liloc
