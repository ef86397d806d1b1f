#include "server/ingest/lidar_monitor.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/base/quantile.hpp"

namespace liloc {
namespace {

constexpr std::ptrdiff_t kJudged = 3;  // frames, before anything is said of what they show
constexpr double kFewestReturns =
    0.01;  // of the pixels; the worst real sensors had 30 % (proto-tests/sim/sensors/SENSORS.md)
constexpr double kLeastUsable = 0.1;  // of the returns
// A LiDAR on a ceiling sees the floor or a wall farther than that; a unit a quarter of the right one does not.
constexpr double kLeastFar_m = 1.5;
constexpr double kOtherRange = 3;  // times the usual: no furniture does that, the smallest mix-up of units is 4
constexpr std::uint64_t kKnown = 50;    // frames before a range is usual
constexpr double kMostAveraged = 5000;  // frames: a quarter of an hour at 6 Hz

/// 0 without frames.
double median_of(const std::vector<FrameContent>& frames, double FrameContent::*field) {
  std::vector<double> values;
  values.reserve(frames.size());
  for (const FrameContent& frame : frames) values.push_back(frame.*field);
  return values.empty() ? 0 : median(std::move(values));
}

}  // namespace

std::chrono::duration<double> LidarMonitor::silence_limit() const {
  return std::chrono::duration<double>(rate_hz_ > 0 ? std::max(1.0, 5 / rate_hz_) : 1.5);
}

std::chrono::duration<double> LidarMonitor::rate_window() const {
  return std::max(std::chrono::duration<double>(2), silence_limit());
}

FrameContent LidarMonitor::lately() const {
  std::vector<FrameContent> all, seeing;  // what is blind tells nothing of ranges
  for (const Frame& frame : recent_) {
    all.push_back(frame.content);
    if (frame.content.returns >= kFewestReturns) seeing.push_back(frame.content);
  }
  return {median_of(all, &FrameContent::returns), median_of(seeing, &FrameContent::usable),
          median_of(seeing, &FrameContent::range_m), median_of(seeing, &FrameContent::far_m)};
}

bool LidarMonitor::implausible(const FrameContent& content) const {
  if (content.usable < kLeastUsable || content.far_m < kLeastFar_m) return true;
  return learned_ >= kKnown && std::abs(std::log(content.range_m / usual_range_m_)) > std::log(kOtherRange);
}

/// What is not plausible is never taken for usual.
void LidarMonitor::learn_range() {
  const FrameContent& newest = recent_.back().content;
  if (newest.returns < kFewestReturns || implausible(newest)) return;
  const double log_range = std::log(newest.range_m);
  ++learned_;
  const double gain = 1 / std::min(static_cast<double>(learned_), kMostAveraged);
  usual_range_m_ = learned_ == 1
                       ? newest.range_m
                       : std::exp(std::log(usual_range_m_) + gain * (log_range - std::log(usual_range_m_)));
}

void LidarMonitor::on_frame(Time now, const FrameContent& content) {
  if (frames_++ == 0 || now - last_frame_ > silence_limit()) {  // it begins, or comes back
    start_ = now;
    recent_.clear();
  }
  malformed_in_a_row_ = 0;
  last_frame_ = now;
  recent_.push_back({now, content});
  while (recent_.size() > 512 || now - recent_.front().at > rate_window()) recent_.pop_front();
  learn_range();
}

void LidarMonitor::on_malformed(Time now, const std::string& error) {
  ++malformed_;
  ++malformed_in_a_row_;
  last_malformed_ = now;
  last_error_ = error.substr(0, 200);
}

std::optional<double> LidarMonitor::age_s(Time now) const {
  if (frames_ == 0) return std::nullopt;
  return std::chrono::duration<double>(now - last_frame_).count();
}

wire::LidarHealth LidarMonitor::assess(Time now) const {
  wire::LidarHealth health{id_, wire::LidarState::ok, 0, frames_, malformed_, last_error_};
  const auto first = std::ranges::find_if(recent_, [&](const Frame& f) { return now - f.at <= rate_window(); });
  const auto count = recent_.end() - first;
  if (count > 1 && now > first->at)
    health.measured_hz =
        static_cast<double>(count - 1) / std::chrono::duration<double>(now - first->at).count();
  const FrameContent content = lately();
  health.returns = content.returns;
  health.range_m = content.range_m;
  health.usual_range_m = learned_ >= kKnown ? usual_range_m_ : 0;
  const bool heard = frames_ > 0 && now - last_frame_ <= silence_limit();
  const bool broken = malformed_ > 0 && now - last_malformed_ <= silence_limit();
  if (broken && (!heard || malformed_in_a_row_ >= 3))
    health.state = wire::LidarState::malformed;
  else if (!heard)
    health.state =
        frames_ == 0 && now - start_ <= silence_limit() ? wire::LidarState::waiting : wire::LidarState::silent;
  else if (count >= kJudged && content.returns < kFewestReturns)
    health.state = wire::LidarState::blind;
  else if (count >= kJudged && implausible(content))
    health.state = wire::LidarState::implausible;
  else if (now - start_ > rate_window() && health.measured_hz < rate_hz_ / 2)
    health.state = wire::LidarState::slow;
  return health;
}

}  // namespace liloc
