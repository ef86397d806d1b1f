#include "client/app/map_odom_slew.hpp"

#include <algorithm>

namespace liloc {

Pose MapOdomSlew::follow(StampNs stamp_ns, const Pose& T_map_odom, const Pose& T_odom_sensor,
                         std::uint32_t segment) {
  const double dt = std::max(0.0, to_seconds(stamp_ns - last_ns_));
  last_ns_ = stamp_ns;
  const bool fresh = !T_map_odom_ || segment != segment_;
  segment_ = segment;
  if (fresh) return *(T_map_odom_ = T_map_odom);
  const Pose told = *T_map_odom_ * T_odom_sensor, wanted = T_map_odom * T_odom_sensor;
  const double moved = distance_m(told, wanted), turned = angle_between_rad(told, wanted);
  double share = 1;
  if (speed_m_s_ > 0 && moved > 0) share = std::min(share, speed_m_s_ * dt / moved);
  if (turn_rate_rad_s_ > 0 && turned > 0) share = std::min(share, turn_rate_rad_s_ * dt / turned);
  if (share >= 1 || moved > snap_m_ || turned > 0.5) return *(T_map_odom_ = T_map_odom);
  return *(T_map_odom_ = normalized(interpolate(told, wanted, share) * T_odom_sensor.inverse()));
}

}  // namespace liloc
