#pragma once
#include <cmath>

#include "common/geometry/camera.hpp"

namespace liloc {

// What no such sensor measures: those of phones, robots and depth cameras end at 2000 degrees per second (35
// rad/s) and 16 g (157 m/s^2), or at 32 g (314 m/s^2); twice the turn rate still leaves no sharp frame.
inline constexpr double kMostRate_rad_s = 50, kMostForce_m_s2 = 320;

/// A value that stays at exactly one as large as `least` is the range's end.
[[nodiscard]] inline bool at_range_end(const Eigen::Vector3d& value, const Eigen::Vector3d& before,
                                       double least) {
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(value[axis]) > least && value[axis] == before[axis]) return true;
  return false;
}
[[nodiscard]] inline bool rate_clips(const Eigen::Vector3d& rate_rad_s, const Eigen::Vector3d& before) {
  return at_range_end(rate_rad_s, before, 3);  // by hand
}
[[nodiscard]] inline bool force_clips(const Eigen::Vector3d& force_m_s2, const Eigen::Vector3d& before) {
  return at_range_end(force_m_s2, before, 15);  // by hand
}

}  // namespace liloc
