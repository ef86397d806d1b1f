#pragma once
#include <deque>
#include <mutex>

#include "client/src/clock_estimator.hpp"
#include "client/src/engine.hpp"

namespace liloc {

struct SessionStats {
  std::uint64_t frames = 0, frames_dropped = 0, frames_refused = 0, frames_uninformative = 0, imu_refused = 0;
  std::uint64_t requests = 0, requests_unsent = 0, requests_unanswered = 0;
  std::uint64_t replies = 0, replies_verified = 0, replies_refused = 0;
  double frame_ms_median = 0, frame_ms_p99 = 0;
  std::uint64_t frames_skipped = 0;  ///< left out to stay within the budget
  std::uint64_t odometry_refused = 0;
  double cpu_s = 0;  ///< of the registration
  std::string problem;
  std::optional<ClockOffset> clock;  ///< of the device against the ceiling
  std::uint64_t clock_jumps = 0;
  double localized_s = 0;  ///< of the device's time, with a global pose
};

/// Where a session stands and what it has done, for whoever asks; what changes for people goes to the log.
/// Thread-safe.
class SessionReport {
 public:
  explicit SessionReport(std::string client_id) : client_id_(std::move(client_id)) {}

  /// A frame was registered; `problem` is what is wrong with the input as of it.
  void frame(const FrameResult& frame, Tracking tracking, std::string problem);
  void reply(const SpotReply& reply);
  void spent(double cpu_s);
  void count(std::uint64_t SessionStats::*what, std::uint64_t by = 1);

  [[nodiscard]] std::optional<FrameResult> newest() const;
  [[nodiscard]] Tracking tracking() const;
  /// All but the clock, which others know.
  [[nodiscard]] SessionStats stats() const;

 private:
  void log_changes(Tracking tracking, const std::string& problem) const;

  const std::string client_id_;
  mutable std::mutex mutex_;
  std::optional<FrameResult> newest_;
  Tracking tracking_ = Tracking::searching;
  SessionStats stats_;
  std::deque<double> latencies_ms_;  ///< of the recent frames
};

}  // namespace liloc
