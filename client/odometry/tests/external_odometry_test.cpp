#include "client/odometry/external_odometry.hpp"

#include <gtest/gtest.h>

#include "common/base/log.hpp"
#include "common/testing/walk.hpp"

namespace liloc {
namespace {

using namespace test;

StampNs at(double seconds) {
  return kStart + from_seconds(seconds);
}

/// Wheels: the walk, seen from a base below the sensor.
class Wheels {
 public:
  explicit Wheels(ExternalOdometryOptions options = {})
      : T_base_sensor_(options.T_base_sensor), odometry(options) {}
  void drive(double from_s, double to_s, double hz, const Pose& T_odom_map = Pose::Identity()) {
    for (double t = from_s; t < to_s; t += 1 / hz)
      ASSERT_TRUE(odometry.add({at(t), T_odom_map * walk(t) * T_base_sensor_.inverse(), std::nullopt}));
  }

 private:
  Pose T_base_sensor_;

 public:
  ExternalOdometry odometry;
};

TEST(ExternalOdometry, PosesAreInterpolatedAtTheFramesStamp) {
  ExternalOdometryOptions options;
  options.T_base_sensor = Eigen::Translation3d(0.2, 0, 1.1) * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitX());
  Wheels wheels(options);
  wheels.drive(0, 5, 50);
  for (double t = 0.01; t < 4.9; t += 0.0667) {
    const OdometryStep step = wheels.odometry.step(at(t));
    EXPECT_EQ(step.source, PoseSource::external);
    EXPECT_TRUE(step.converged && wheels.odometry.placed());
    EXPECT_LT(distance_m(step.T_odom_sensor, walk(t)), 1e-3) << t;
    EXPECT_LT(angle_between_rad(step.T_odom_sensor, walk(t)), 1e-3) << t;
    EXPECT_EQ(step.segment, 0U);
  }
}

TEST(ExternalOdometry, ALittleBeyondTheNewestIsGuessedAndMoreIsNot) {
  Wheels wheels;
  wheels.drive(0, 3, 50);
  const OdometryStep near = wheels.odometry.step(at(3.03));
  EXPECT_EQ(near.source, PoseSource::guess);
  EXPECT_FALSE(near.converged);
  EXPECT_TRUE(wheels.odometry.placed());
  EXPECT_GT(near.sd_m, 0.0);
  EXPECT_LT(distance_m(near.T_odom_sensor, walk(3.03)), 0.01);
  const OdometryStep far = wheels.odometry.step(at(3.5));
  EXPECT_FALSE(wheels.odometry.placed());
  EXPECT_LT(distance_m(far.T_odom_sensor, near.T_odom_sensor), 1e-12);  // held, not invented
}

TEST(ExternalOdometry, NothingBeforeTheFirstSample) {
  Wheels wheels;
  EXPECT_FALSE(wheels.odometry.step(at(0.5)).converged);
  EXPECT_FALSE(wheels.odometry.placed());
}

TEST(ExternalOdometry, AGapStartsANewSegment) {
  Wheels wheels;
  wheels.drive(0, 2, 20);
  EXPECT_EQ(wheels.odometry.step(at(1.9)).segment, 0U);
  wheels.drive(3.5, 5, 20);
  static_cast<void>(wheels.odometry.step(at(2.5)));
  EXPECT_FALSE(wheels.odometry.placed());  // nobody knows what happened in between
  EXPECT_EQ(wheels.odometry.step(at(4)).segment, 1U);
}

TEST(ExternalOdometry, AJumpStartsANewSegmentAndNothingIsMixedAcrossIt) {
  Wheels wheels;
  wheels.drive(0, 2, 50);
  const Pose moved(Eigen::Translation3d(0.4, 0, 0));  // its keeper corrected it
  wheels.drive(2, 4, 50, moved);
  EXPECT_EQ(wheels.odometry.step(at(1.97)).segment, 0U);
  const OdometryStep after = wheels.odometry.step(at(2.5));
  EXPECT_EQ(after.segment, 1U);
  EXPECT_LT(distance_m(after.T_odom_sensor, moved * walk(2.5)), 1e-3);
  const OdometryStep between = wheels.odometry.step(at(1.99));
  EXPECT_LT(distance_m(between.T_odom_sensor, walk(1.99)), 0.01);
}

TEST(ExternalOdometry, BadSamplesAreRefusedAndHarmless) {
  Wheels wheels;
  wheels.drive(0, 1, 50);
  Pose bad = Pose::Identity();
  bad.translation().x() = NAN;
  EXPECT_FALSE(wheels.odometry.add({at(2), bad, std::nullopt}));
  EXPECT_FALSE(wheels.odometry.add({at(0.5), walk(0.5), std::nullopt}));
  EXPECT_EQ(wheels.odometry.step(at(0.9)).source, PoseSource::external);
}

TEST(ExternalOdometry, TheCovariancesGrowthIsTheMotionsError) {
  ExternalOdometry odometry({});
  for (int i = 0; i <= 10; ++i)
    ASSERT_TRUE(odometry.add({at(0.1 * i), Pose::Identity(), Matrix6d(1e-4 * i * Matrix6d::Identity())}));
  static_cast<void>(odometry.step(at(0.2)));
  odometry.mark();
  EXPECT_NEAR(odometry.step(at(1.0)).sd_m, std::sqrt(8e-4), 1e-9);
}

TEST(ExternalOdometry, WhatJumpsWithEachSampleIsToldInOneLineAndAsAProblem) {
  int lines = 0;
  log::set_sink([&](log::Level, std::string_view) { ++lines; });
  ExternalOdometry odometry({});
  for (int i = 0; i < 100; ++i) {  // 0.5 m/s in millimetres, at 50 Hz
    Pose T_odom_base = Pose::Identity();
    T_odom_base.translation().x() = 10.0 * i;
    ASSERT_TRUE(odometry.add({at(0.02 * i), T_odom_base, std::nullopt}));
  }
  log::set_sink({});
  EXPECT_EQ(lines, 1);
  EXPECT_NE(odometry.problem().find("10.00 m in 0.02 s"), std::string::npos) << odometry.problem();
  Pose T_odom_base = Pose::Identity();
  T_odom_base.translation().x() = 990;
  for (int i = 100; i < 150; ++i) ASSERT_TRUE(odometry.add({at(0.02 * i), T_odom_base, std::nullopt}));
  EXPECT_EQ(odometry.problem(), "") << "it is mended";
}

TEST(ExternalOdometry, OneJumpIsNoProblem) {
  Wheels wheels;
  wheels.drive(0, 1, 50);
  wheels.drive(1, 2, 50, Pose(Eigen::Translation3d(3, 0, 0)));
  EXPECT_EQ(wheels.odometry.problem(), "");
}

}  // namespace
}  // namespace liloc
