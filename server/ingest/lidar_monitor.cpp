#include "server/ingest/lidar_monitor.hpp"

#include <algorithm>

namespace liloc {

std::chrono::duration<double> LidarMonitor::silence_limit() const {
  return std::chrono::duration<double>(rate_hz_ > 0 ? std::max(1.0, 5 / rate_hz_) : 1.5);
}

std::chrono::duration<double> LidarMonitor::rate_window() const {
  return std::max(std::chrono::duration<double>(2), silence_limit());
}

void LidarMonitor::on_frame(Time now) {
  if (frames_++ == 0 || now - last_frame_ > silence_limit()) {  // it begins, or comes back
    start_ = now;
    recent_.clear();
  }
  malformed_in_a_row_ = 0;
  last_frame_ = now;
  recent_.push_back(now);
  while (recent_.size() > 512 || now - recent_.front() > rate_window()) recent_.pop_front();
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
  const auto first = std::ranges::find_if(recent_, [&](Time t) { return now - t <= rate_window(); });
  if (const auto count = recent_.end() - first; count > 1 && now > *first)
    health.measured_hz = static_cast<double>(count - 1) / std::chrono::duration<double>(now - *first).count();
  const bool heard = frames_ > 0 && now - last_frame_ <= silence_limit();
  const bool broken = malformed_ > 0 && now - last_malformed_ <= silence_limit();
  if (broken && (!heard || malformed_in_a_row_ >= 3))
    health.state = wire::LidarState::malformed;
  else if (!heard)
    health.state =
        frames_ == 0 && now - start_ <= silence_limit() ? wire::LidarState::waiting : wire::LidarState::silent;
  else if (now - start_ > rate_window() && health.measured_hz < rate_hz_ / 2)
    health.state = wire::LidarState::slow;
  return health;
}

}  // namespace liloc
