#pragma once
#include "server/localization/following.hpp"

namespace liloc::test {

/// What a server remembers of a device at (`x_m`, 4, 1.2); every field differs from its default.
inline Remembered remembered_device(double x_m = 3) {
  Remembered remembered;
  remembered.odom_segment = 7;
  Followed& f = remembered.followed;
  f.estimate.T_map_sensor =
      Eigen::Translation3d(x_m, 4, 1.2) * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ());
  f.estimate.covariance = 1e-4 * Matrix6d::Identity();
  f.estimate.covariance(0, 5) = f.estimate.covariance(5, 0) = 2e-5;
  f.T_odom_sensor.translation() = Eigen::Vector3d(9, 8, 7);
  f.log_odds = 6.5;
  f.usual = {0.3, 1.2, 0.01, 0};
  return remembered;
}

}  // namespace liloc::test
