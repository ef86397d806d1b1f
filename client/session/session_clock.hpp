#pragma once
#include <mutex>

#include "client/session/clock_estimator.hpp"
#include "common/base/stamp_clock.hpp"
#include "common/protocol/spot.hpp"

namespace liloc {

/// What a client knows of two clocks that nobody set by each other: the device's, by its frames' stamps, and
/// the ceiling's against it, by the exchanges with the server. Thread-safe.
class SessionClock {
 public:
  using Time = StampClock::Time;

  /// A frame of the device came. True when its clock was set: all is then learned anew.
  bool frame(StampNs stamp_ns, Time arrived);
  /// The device's clock was set: all is learned anew.
  void forget();
  /// Writes the time of sending, and the frame's time by the ceiling's clock where that is known well.
  void stamp(SpotRequest& request, Time sent) const;
  /// Learns from a reply. True when the two clocks have jumped against each other.
  bool learn(const SpotReply& reply, Time arrived);
  /// Of the device against the ceiling; empty before the first reply.
  [[nodiscard]] std::optional<ClockOffset> offset() const;

 private:
  mutable std::mutex mutex_;
  StampClock device_;
  ClockEstimator ceiling_;
};

}  // namespace liloc
