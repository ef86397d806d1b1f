#include "server/ingest/lidar_monitor.hpp"

#include <algorithm>

namespace liloc {

std::chrono::duration<double> LidarMonitor::silence_limit() const {
  return std::chrono::duration<double>(rate_hz_ > 0 ? std::max(1.0, 5 / rate_hz_) : 1.5);
}

void LidarMonitor::on_frame(Time now) {
  ++frames_;
  malformed_in_a_row_ = 0;
  last_frame_ = now;
  recent_.push_back(now);
  while (recent_.size() > 512 || now - recent_.front() > kWindow) recent_.pop_front();
}

void LidarMonitor::on_malformed(Time now, const std::string& error) {
  ++malformed_;
  ++malformed_in_a_row_;
  last_malformed_ = now;
  last_error_ = error.substr(0, 200);
}

wire::LidarHealth LidarMonitor::assess(Time now) const {
  wire::LidarHealth health{id_, wire::LidarState::ok, 0, frames_, malformed_, last_error_};
  const auto in_window =
      std::count_if(recent_.begin(), recent_.end(), [&](Time t) { return now - t <= kWindow; });
  const double seen_s = std::min<double>(std::chrono::duration<double>(now - start_).count(),
                                         std::chrono::duration<double>(kWindow).count());
  health.measured_hz = seen_s > 0 ? static_cast<double>(in_window) / seen_s : 0;
  const bool heard = frames_ > 0 && now - last_frame_ <= silence_limit();
  const bool broken = malformed_ > 0 && now - last_malformed_ <= silence_limit();
  const bool first_window = frames_ > 0 && now - start_ < kWindow + silence_limit();
  if (broken && (!heard || malformed_in_a_row_ >= 3))
    health.state = wire::LidarState::malformed;
  else if (!heard)
    health.state =
        frames_ == 0 && now - start_ <= silence_limit() ? wire::LidarState::waiting : wire::LidarState::silent;
  else if (!first_window && health.measured_hz < rate_hz_ / 2)
    health.state = wire::LidarState::slow;
  return health;
}

}  // namespace liloc
