#pragma once
// The health of one ceiling LiDAR, from when its frames come and what they show. Times are passed in: no clock
// in here.
#include <chrono>
#include <deque>
#include <optional>
#include <string>

#include "common/wire/spots/status.hpp"
#include "server/ingest/frame_content.hpp"

namespace liloc {

class LidarMonitor {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// `rate_hz` is what the site expects; 0 where it does not say.
  LidarMonitor(std::string id, double rate_hz, Time start)
      : id_(std::move(id)), rate_hz_(rate_hz), start_(start) {}

  void on_frame(Time now, const FrameContent& content);
  void on_malformed(Time now, const std::string& error);

  /// waiting: nothing yet, and that for less than the limit; silent: no good frame for five periods, at least
  /// one second; malformed: so were the last three, or all of late; blind, implausible: so are the frames of
  /// the last seconds in the median; slow: under half of the expected rate over two seconds, once it has run
  /// for as long.
  [[nodiscard]] wire::LidarHealth assess(Time now) const;
  /// Since the newest good frame came; empty before the first.
  [[nodiscard]] std::optional<double> age_s(Time now) const;

 private:
  struct Frame {
    Time at;
    FrameContent content;
  };
  [[nodiscard]] std::chrono::duration<double> silence_limit() const;
  [[nodiscard]] std::chrono::duration<double> rate_window() const;  ///< two seconds, or more for a slow LiDAR
  [[nodiscard]] FrameContent lately() const;  ///< medians over `recent_`; ranges: over what sees
  [[nodiscard]] bool implausible(const FrameContent& content) const;
  void learn_range();

  std::string id_;
  double rate_hz_;
  Time start_, last_frame_, last_malformed_;
  std::deque<Frame> recent_;  // frames of the rate window, at most 512
  std::uint64_t frames_ = 0, malformed_ = 0, malformed_in_a_row_ = 0, learned_ = 0;
  double usual_range_m_ = 0;  // mean of its logarithm over what was plausible
  std::string last_error_;
};

}  // namespace liloc
