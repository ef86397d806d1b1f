#pragma once
#include <optional>

#include "common/base/stamp.hpp"
#include "common/geometry/pose.hpp"

namespace liloc {

/// Moves map -> odom to each correction at a bounded speed, for followers that a step upsets. What moves evenly
/// is the device's place in the map: odometry's origin may be far away. Not thread-safe.
class MapOdomSlew {
 public:
  /// 0: no bound. Farther off than `snap_m` or a half radian, it steps all the same: it was lost.
  explicit MapOdomSlew(double speed_m_s = 0, double turn_rate_rad_s = 0, double snap_m = 0.5)
      : speed_m_s_(speed_m_s), turn_rate_rad_s_(turn_rate_rad_s), snap_m_(snap_m) {}

  /// map -> odom to be told at `stamp_ns`; stamps rise. A new segment steps.
  [[nodiscard]] Pose follow(StampNs stamp_ns, const Pose& T_map_odom, const Pose& T_odom_sensor,
                            std::uint32_t segment);

 private:
  double speed_m_s_, turn_rate_rad_s_, snap_m_;
  std::optional<Pose> T_map_odom_;
  StampNs last_ns_ = 0;
  std::uint32_t segment_ = 0;
};

}  // namespace liloc
