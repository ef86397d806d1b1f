// One record of what was seen and felt, and what each comparison says of it when the IMU is wrong in one way.
#include "client/inertial/imu_agreement.hpp"

#include <gtest/gtest.h>

#include <functional>

#include "common/testing/box_room.hpp"

namespace liloc {
namespace {

using Eigen::Vector3d;

constexpr StampNs kStart_ns = 1'700'000'000'000'000'000;
constexpr double kFrameHz = 15;

Pose looking_about(double t) {
  return scene::looking({3 + 0.9 * std::sin(0.7 * t), 2.5 + 0.7 * std::sin(0.9 * t), 1.2},
                        0.6 * std::sin(1.1 * t) + 0.25 * std::sin(2.3 * t), 0.2 + 0.15 * std::sin(1.7 * t));
}
Pose standing(double) {
  return scene::looking({3, 2.5, 1.2}, 0.3, 0.2);
}

/// Ten seconds; the IMU sits at the sensor.
MotionRecord played(const std::function<Pose(double)>& path,
                    const std::function<void(ImuSample&)>& spoil = {}) {
  MotionRecord record;
  for (ImuSample sample : scene::imu_along(path, Pose::Identity(), 0, 13, 200, kStart_ns)) {
    if (spoil) spoil(sample);
    record.feel(sample);
  }
  for (int i = 0; i < 150; ++i) {
    const double from_s = 1 + i / kFrameHz, to_s = 1 + (i + 1) / kFrameHz;
    const Pose from = path(from_s), to = path(to_s);
    record.see({kStart_ns + from_seconds(from_s), kStart_ns + from_seconds(to_s), to.linear(),
                so3_log(from.linear().transpose() * to.linear()) * kFrameHz,
                to.translation() - from.translation()});
  }
  return record;
}

TEST(ImuAgreement, OfARightImuAllAgree) {
  const MotionRecord record = played(looking_about);
  EXPECT_EQ(gyro_agreement(record, Vector3d::Zero()), Agreement::agrees);
  EXPECT_EQ(force_agreement(record), Agreement::agrees);
  EXPECT_EQ(sign_agreement(record), Agreement::agrees);
  EXPECT_NEAR(gyro_factor(record).value_or(0), 1, 0.02);
  EXPECT_FALSE(stamps_ahead_ns(record));
  EXPECT_LT((*mean_force_m_s2(record) - Vector3d(0, 0, 9.81)).norm(), 1.0);
}

TEST(ImuAgreement, ADeviceThatStandsTellsNothingOfGyroAndSign) {
  const MotionRecord record = played(standing);
  EXPECT_EQ(gyro_agreement(record, Vector3d::Zero()), Agreement::unknown);
  EXPECT_EQ(sign_agreement(record), Agreement::unknown);
  EXPECT_EQ(force_agreement(record), Agreement::agrees);
  EXPECT_FALSE(gyro_factor(record));
  EXPECT_FALSE(stamps_ahead_ns(record));
}

TEST(ImuAgreement, OfNothingNothingIsKnown) {
  const MotionRecord record;
  EXPECT_EQ(gyro_agreement(record, Vector3d::Zero()), Agreement::unknown);
  EXPECT_EQ(force_agreement(record), Agreement::unknown);
  EXPECT_EQ(sign_agreement(record), Agreement::unknown);
  EXPECT_FALSE(mean_force_m_s2(record) || gyro_factor(record) || stamps_ahead_ns(record));
}

TEST(ImuAgreement, ABiasIsTakenOffTheGyroBeforeItIsCompared) {
  const Vector3d bias_rad_s(0.4, -0.3, 0.2);
  const MotionRecord record =
      played(looking_about, [&](ImuSample& s) { s.angular_velocity_rad_s += bias_rad_s; });
  EXPECT_EQ(gyro_agreement(record, bias_rad_s), Agreement::agrees);
  EXPECT_EQ(gyro_agreement(record, Vector3d::Zero()), Agreement::contradicts);
}

TEST(ImuAgreement, AGyroInOtherUnitsOrTurnedContradictsAndTheFactorTellsWhich) {
  const auto degrees_per_second = [](ImuSample& s) { s.angular_velocity_rad_s *= 180 / M_PI; };
  const auto axes = [](ImuSample& s) {
    const Vector3d w = s.angular_velocity_rad_s;
    s.angular_velocity_rad_s = {w.y(), w.z(), w.x()};
  };
  const MotionRecord units = played(looking_about, degrees_per_second), turned = played(looking_about, axes);
  EXPECT_EQ(gyro_agreement(units, Vector3d::Zero()), Agreement::contradicts);
  EXPECT_EQ(gyro_agreement(turned, Vector3d::Zero()), Agreement::contradicts);
  EXPECT_NEAR(gyro_factor(units).value_or(0), 180 / M_PI, 2);
  EXPECT_FALSE(gyro_factor(turned)) << "it is no multiple";
}

TEST(ImuAgreement, AnInvertedForceIsFoundBySignAloneAndAScaledOneByItsSize) {
  const MotionRecord inverted =
      played(looking_about, [](ImuSample& s) { s.specific_force_m_s2 = -s.specific_force_m_s2; });
  EXPECT_EQ(force_agreement(inverted), Agreement::agrees) << "as much gravity, which stays where it is";
  EXPECT_EQ(sign_agreement(inverted), Agreement::contradicts);
  const MotionRecord scaled = played(looking_about, [](ImuSample& s) { s.specific_force_m_s2 *= 1.5; });
  EXPECT_EQ(force_agreement(scaled), Agreement::contradicts);
}

TEST(ImuAgreement, AForceThatTurnsWithTheDeviceContradicts) {
  const auto turning = [](double t) { return scene::looking({3, 2.5, 1.2}, 0.8 * t, 0.2); };
  const MotionRecord record =
      played(turning, [](ImuSample& s) { s.specific_force_m_s2 = Vector3d(9.81, 0, 0); });
  EXPECT_EQ(force_agreement(record), Agreement::contradicts);
}

TEST(ImuAgreement, StampsThatAreAheadOrBehindAreFoundToAFrame) {
  for (const double ahead_s : {-0.9, -0.2, 0.1, 0.6}) {
    const MotionRecord record =
        played(looking_about, [&](ImuSample& s) { s.stamp_ns += from_seconds(ahead_s); });
    const auto found = stamps_ahead_ns(record);
    ASSERT_TRUE(found) << ahead_s;
    EXPECT_NEAR(to_seconds(*found), ahead_s, 0.02);
  }
}

}  // namespace
}  // namespace liloc
