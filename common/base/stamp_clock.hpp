#pragma once
#include <chrono>
#include <deque>
#include <optional>

#include "common/base/stamp.hpp"

namespace liloc {

/// What a clock shows that is only seen by the stamps of a stream: the newest stamps plus the time since they
/// came. The least delayed of the recent ones counts, so that a late one does no harm; the delay that all have
/// in common stays in it. Not thread-safe.
class StampClock {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// True when the clock was set: it then starts anew with this stamp.
  bool add(StampNs stamp_ns, Time arrived);
  /// Empty before the first stamp, and when none came for three seconds: nobody knows then whether it runs on.
  [[nodiscard]] std::optional<StampNs> now(Time at) const;

 private:
  struct Lead {
    Time arrived;
    StampNs lead_ns;  ///< of the stamp on the steady clock
  };
  [[nodiscard]] StampNs best() const;

  std::deque<Lead> recent_;
  int late_ = 0;  ///< stamps in a row that came far too late
};

}  // namespace liloc
