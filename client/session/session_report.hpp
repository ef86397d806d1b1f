#pragma once
#include <deque>
#include <mutex>
#include <utility>
#include <vector>

#include "client/engine/engine.hpp"
#include "client/session/clock_estimator.hpp"
#include "common/base/line_limit.hpp"
#include "common/base/log.hpp"

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
  double localized_s = 0;             ///< of the device's time, with a global pose
  std::uint64_t replies_dropped = 0;  ///< they were not to be understood
  std::uint64_t refusals_in_row = 0;  ///< the newest replies, and why the newest was one
  Reason newest_refusal = Reason::none;
  std::uint64_t replies_strange = 0;  ///< that nobody asked for; they count for nothing
};

/// Where a session stands and what it has done, for whoever asks; what changes for people goes to the log.
/// Thread-safe; who hears a line may ask.
class SessionReport {
 public:
  using Time = std::chrono::steady_clock::time_point;
  using Counter = std::uint64_t SessionStats::*;

  explicit SessionReport(std::string client_id) : client_id_(std::move(client_id)) {}

  /// A frame was registered; `problem` is what is wrong with the input as of it.
  void frame(const FrameResult& frame, Tracking tracking, std::string problem);
  /// A frame was refused: counted, told, and the problem until the next one is taken.
  void frame_refused(const std::string& why);
  /// A frame was left out on purpose: the device still sees.
  void frame_skipped();
  /// Of `count` samples the first for this reason.
  void samples_refused(Counter what, std::uint64_t count, const std::string& why);
  /// Told once, and a problem from then on where there is no other.
  void trace_failed(const std::string& why);
  /// No more frames are to come, and none is missed.
  void ended();
  void reply(const SpotReply& reply);
  void reply_dropped(const std::string& why);
  void spent(double cpu_s);
  void count(Counter what, std::uint64_t by = 1);

  [[nodiscard]] std::optional<FrameResult> newest() const;
  /// Lost when no frame was taken for two seconds, or the newest three were refused: the device may be
  /// anywhere by then.
  [[nodiscard]] Tracking tracking(Time now = std::chrono::steady_clock::now()) const;
  /// All but the clock, which others know.
  [[nodiscard]] SessionStats stats(Time now = std::chrono::steady_clock::now()) const;

 private:
  using Lines = std::vector<std::pair<log::Level, std::string>>;
  /// Without the lock.
  void write(const Lines& lines) const;
  /// The line, or none where it was said a moment ago.
  [[nodiscard]] Lines limited(Counter what, const std::string& why);
  [[nodiscard]] bool blind(Time now) const;
  [[nodiscard]] Lines changes(Tracking tracking, const std::string& problem) const;

  const std::string client_id_;
  mutable std::mutex mutex_;
  std::optional<FrameResult> newest_;
  Tracking tracking_ = Tracking::searching;
  SessionStats stats_;
  Time seen_{};      ///< when the newest frame was taken, or left out on purpose
  int refused_ = 0;  ///< frames in a row
  bool ended_ = false;
  std::string trace_problem_;
  std::vector<std::pair<Counter, LineLimit>> limits_;  ///< by what was refused
  std::deque<double> latencies_ms_;                    ///< of the recent frames
};

}  // namespace liloc
