#pragma once
// Private to the room: whether another device asks under a client's id, told by the answers to it.
#include <chrono>
#include <cstdint>

namespace liloc::wire {

/// Replies to other sessions are mostly left from an earlier run of this client, kept by the server or on their
/// way when it ended: those come at once. Later ones show a device that lives. Not thread-safe.
class Namesake {
 public:
  using Time = std::chrono::steady_clock::time_point;
  static constexpr auto kLeftover =
      std::chrono::seconds(2);  // after this an answer to an ended run is not on its way

  /// To be asked of each reply to another session; true where that session still asks.
  [[nodiscard]] bool lives(std::uint64_t session, std::uint64_t seq, Time now) {
    if (session != session_) {
      session_ = session;
      first_ = now;
      seq_ = seq;
      return false;
    }
    const bool newer = seq > seq_;
    if (newer) seq_ = seq;
    return newer && now - first_ > kLeftover;
  }

 private:
  std::uint64_t session_ = 0, seq_ = 0;
  Time first_{};
};

}  // namespace liloc::wire
