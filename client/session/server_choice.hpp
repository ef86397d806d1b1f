#pragma once
#include <chrono>
#include <optional>
#include <string>

#include "common/protocol/spot.hpp"

namespace liloc {

/// Which server's answers count where several answer each request, a server and its standby: one is followed
/// until it fails to answer, or to verify, what another does. Not thread-safe.
///
/// What another verified counts as soon as the followed one is late with the same request: later behind the
/// other than it used to be. Without that two requests decide, so that the slower of two good servers is not
/// left for being slow.
class ServerChoice {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// To be asked of each reply as it comes; true where it counts.
  [[nodiscard]] bool takes(const SpotReply& reply, Time now);
  /// To be asked often: a reply that `takes` did not take, and that counts by now. Once.
  [[nodiscard]] std::optional<SpotReply> take_overdue(Time now);
  /// By its server_id; empty before the first reply.
  [[nodiscard]] const std::string& followed() const { return followed_; }

 private:
  struct Held {
    SpotReply reply;
    Time at;
  };
  void hold(const SpotReply& reply, Time now);
  void follow(const SpotReply& reply, Time now);
  [[nodiscard]] std::chrono::nanoseconds patience() const;

  std::string followed_;
  std::uint64_t answered_seq_ = 0, verified_seq_ = 0;  ///< newest of the followed server
  std::optional<Held> held_;                           ///< of another, verified; newer than what was answered
  std::chrono::nanoseconds lag_{0};  ///< of the followed behind the other, the longest of late
};

}  // namespace liloc
