#pragma once
// A recording as one stream of events, in the order in which they happen.
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>
#include <vector>

#include "common/recording/recording.hpp"

namespace liloc::replay {

struct Event {
  enum class Kind { ceiling, imu, device };  ///< at equal stamps, in this order
  StampNs stamp_ns = 0;
  Kind kind = Kind::ceiling;
  std::size_t source = 0;  ///< index of the LiDAR or device
  std::size_t index = 0;   ///< of its frame or sample
  StampNs due_ns = 0;      ///< when it happens, by the ceiling's clock
};

/// `device_ahead_ns`: how far the devices' clocks run ahead of the ceiling's; a recording holds stamps alone.
[[nodiscard]] std::vector<Event> timeline(const Recording& recording, StampNs device_ahead_ns = 0);
/// From the first event to the last.
[[nodiscard]] double recorded_seconds(const std::vector<Event>& events);

/// Decodes the depth frames of a timeline a little ahead, on a thread of its own. `recording` and `events` must
/// outlive it. `next` belongs to one thread.
class FrameReader {
 public:
  FrameReader(const Recording& recording, const std::vector<Event>& events, std::size_t ahead = 16);

  /// The next frame of a ceiling or device event, in the order of the timeline; blocks until it is decoded.
  /// Error: that frame is damaged. Call it once per such event.
  [[nodiscard]] Result<DepthImage> next();

 private:
  void run(const std::stop_token& stop);

  const Recording& recording_;
  const std::vector<Event>& events_;
  const std::size_t ahead_;
  std::mutex mutex_;
  std::condition_variable_any changed_;
  std::deque<Result<DepthImage>> decoded_;
  std::jthread worker_;  // last member: stops and joins before the rest goes away
};

}  // namespace liloc::replay
