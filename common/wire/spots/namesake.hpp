#pragma once
// Private to the room: whether another device asks under a client's id, told by the answers to it.
#include <algorithm>
#include <chrono>
#include <cstdint>
#include <deque>

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
    const auto known = std::ranges::find(runs_, session, &Run::session);
    if (known == runs_.end()) {
      runs_.push_back({session, seq, now});
      if (runs_.size() > kRuns) runs_.pop_front();
      return false;
    }
    const bool newer = seq > known->seq;
    if (newer) known->seq = seq;
    return newer && now - known->first > kLeftover;
  }

 private:
  static constexpr std::size_t kRuns = 8;  // a forger may make up any number; a cloned image makes a few
  struct Run {
    std::uint64_t session, seq;
    Time first;
  };
  std::deque<Run> runs_;
};

}  // namespace liloc::wire
