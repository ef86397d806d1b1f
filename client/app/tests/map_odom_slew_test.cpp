#include "client/app/map_odom_slew.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

Pose moved(double x, double yaw_rad = 0) {
  Pose T(Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()));
  T.translation().x() = x;
  return T;
}

StampNs at(double s) {
  return from_seconds(s) + 1;
}

TEST(MapOdomSlew, WithoutBoundsItSteps) {
  MapOdomSlew slew;
  EXPECT_DOUBLE_EQ(slew.follow(at(0), moved(1), Pose::Identity(), 0).translation().x(), 1);
  EXPECT_DOUBLE_EQ(slew.follow(at(0.1), moved(1.2), Pose::Identity(), 0).translation().x(), 1.2);
}

TEST(MapOdomSlew, ACorrectionIsReachedAtTheSpeedAndNotPassed) {
  MapOdomSlew slew(0.5);
  static_cast<void>(slew.follow(at(0), moved(0), Pose::Identity(), 0));
  EXPECT_NEAR(slew.follow(at(0.1), moved(0.12), Pose::Identity(), 0).translation().x(), 0.05, 1e-9);
  EXPECT_NEAR(slew.follow(at(0.2), moved(0.12), Pose::Identity(), 0).translation().x(), 0.10, 1e-9);
  EXPECT_NEAR(slew.follow(at(0.3), moved(0.12), Pose::Identity(), 0).translation().x(), 0.12, 1e-9);
}

/// Far from odometry's origin a small turn of map -> odom would swing the device: its own place must move
/// evenly.
TEST(MapOdomSlew, TheDeviceMovesEvenlyFarFromTheOrigin) {
  MapOdomSlew slew(0.5, 0.2);
  const Pose T_odom_sensor = moved(100);
  static_cast<void>(slew.follow(at(0), moved(0), T_odom_sensor, 0));
  const Pose wanted = moved(0.1, 0.002);  // the device: 0.2 m aside
  Pose last = moved(100);
  for (int i = 1; i <= 20; ++i) {
    const Pose now = slew.follow(at(0.05 * i), wanted, T_odom_sensor, 0) * T_odom_sensor;
    EXPECT_LE(distance_m(last, now), 0.5 * 0.05 + 1e-9);
    EXPECT_LE(angle_between_rad(last, now), 0.2 * 0.05 + 1e-9);
    last = now;
  }
  EXPECT_LT(distance_m(last, wanted * T_odom_sensor), 1e-6);
}

TEST(MapOdomSlew, ANewSegmentAndALargeErrorStep) {
  MapOdomSlew slew(0.1);
  static_cast<void>(slew.follow(at(0), moved(0), Pose::Identity(), 0));
  EXPECT_DOUBLE_EQ(slew.follow(at(0.1), moved(3), Pose::Identity(), 0).translation().x(), 3);
  EXPECT_DOUBLE_EQ(slew.follow(at(0.2), moved(3.3), Pose::Identity(), 1).translation().x(), 3.3);
}

}  // namespace
}  // namespace liloc
