#include "client/inertial/imu_track.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "common/base/log.hpp"
#include "common/testing/box_room.hpp"

namespace liloc {
namespace {

constexpr StampNs kStart = 1'700'000'000'000'000'000;
const Eigen::Vector3d kBias(0.004, -0.003, 0.002);

/// Still for two seconds, then walks and turns.
Pose walk(double t) {
  const double s = std::max(0.0, t - 2), ramp = s * s / (s + 0.5);
  return scene::looking(
      {3 + 0.8 * std::sin(0.6 * ramp), 2.5 + 0.6 * std::sin(0.8 * ramp), 1.2 + 0.03 * std::sin(6 * ramp)},
      0.5 * ramp, 0.15 + 0.1 * std::sin(ramp));
}

Pose mounting() {
  Pose T = Pose::Identity();
  T.linear() = so3_exp({0.4, -1.1, 0.7});
  T.translation() = Eigen::Vector3d(0.01, 0.0, 0.005);
  return T;
}

ImuTrack fed(double seconds, double still_seconds, unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> gyro(0, 0.003), force(0, 0.04);
  ImuTrack track({.still_seconds = still_seconds});
  for (ImuSample s : scene::imu_along(walk, mounting(), 0, seconds, 200, kStart)) {
    s.angular_velocity_rad_s += kBias + Eigen::Vector3d(gyro(rng), gyro(rng), gyro(rng));
    s.specific_force_m_s2 += Eigen::Vector3d(force(rng), force(rng), force(rng));
    EXPECT_TRUE(track.add(s));
  }
  return track;
}

class ImuTrackLaw : public testing::TestWithParam<unsigned> {};

TEST_P(ImuTrackLaw, CalibratesTheBiasWhileStill) {
  const ImuTrack track = fed(2.5, 2.0, GetParam());
  EXPECT_TRUE(track.calibrated());
  EXPECT_LT((track.gyro_bias_rad_s() - kBias).norm(), 8e-4);
}

TEST_P(ImuTrackLaw, RotationIsTheMotions) {
  const ImuTrack track = fed(5.5, 2.0, GetParam());
  const StampNs from = kStart + from_seconds(3.013), to = kStart + from_seconds(3.913);
  ASSERT_TRUE(track.covers(from, to));
  const Pose T = mounting();
  const Eigen::Matrix3d truth =
      T.linear() * walk(3.013).linear().transpose() * walk(3.913).linear() * T.linear().transpose();
  EXPECT_LT(so3_log(truth.transpose() * track.rotation(from, to)).norm(), 0.003);
}

TEST_P(ImuTrackLaw, UpStaysWithinADegreeWhileWalking) {
  const ImuTrack track = fed(10.0, 2.0, GetParam());
  for (double t = 6.5; t < 10; t += 0.23) {
    const auto up = track.up(kStart + from_seconds(t));
    ASSERT_TRUE(up);
    const Eigen::Vector3d truth = mounting().linear() * walk(t).linear().transpose() * Eigen::Vector3d::UnitZ();
    EXPECT_LT(degrees(std::acos(std::min(1.0, up->dot(truth)))), 1.0) << "at " << t << " s";
  }
}

TEST_P(ImuTrackLaw, MotionIsTheMotionsToMillimetres) {
  const ImuTrack track = fed(5.5, 2.0, GetParam());
  const double from = 3.0, to = 3.1, h = 1e-4;
  const Pose T_imu_sensor = mounting();
  const auto T_map_imu = [&](double t) { return walk(t) * T_imu_sensor.inverse(); };
  const Pose start = T_map_imu(from);
  const Eigen::Vector3d velocity =
      (T_map_imu(from + h).translation() - T_map_imu(from - h).translation()) / (2 * h);
  const auto motion = track.motion(kStart + from_seconds(from), kStart + from_seconds(to),
                                   start.linear().transpose() * velocity);
  EXPECT_LT(distance_m(motion.T_start_end, start.inverse() * T_map_imu(to)), 0.004);
}

INSTANTIATE_TEST_SUITE_P(Seeds, ImuTrackLaw, testing::Range(1U, 7U));

TEST(ImuTrack, ADeviceThatDoesNotStandStillIsNotCalibratedFromItsMotion) {
  ImuTrack track({.still_seconds = 5});  // it says five seconds, and starts to walk after two
  for (const ImuSample& s : scene::imu_along(walk, mounting(), 0, 5, 200, kStart)) EXPECT_TRUE(track.add(s));
  EXPECT_FALSE(track.still());
  EXPECT_TRUE(track.calibrated());
  EXPECT_LT(track.gyro_bias_rad_s().norm(), 0.02);
}

TEST(ImuTrack, OdometryTeachesTheBiasWithoutACalibration) {
  ImuTrack track({.still_seconds = 0});
  StampNs last = 0;
  int i = 0;
  for (ImuSample s : scene::imu_along(walk, Pose::Identity(), 0, 20, 200, kStart)) {
    s.angular_velocity_rad_s += kBias;
    ASSERT_TRUE(track.add(s));
    if (++i % 13 != 0) continue;
    if (last != 0)
      track.observe_rotation(last, s.stamp_ns,
                             walk(to_seconds(last - kStart)).linear().transpose() *
                                 walk(to_seconds(s.stamp_ns - kStart)).linear());
    last = s.stamp_ns;
  }
  EXPECT_LT((track.gyro_bias_rad_s() - kBias).norm(), 0.001);
}

TEST(ImuTrack, GapsAreNotCovered) {
  ImuTrack track({});
  for (int i = 0; i < 100; ++i)
    ASSERT_TRUE((i >= 40 && i <= 60) || track.add({kStart + from_ms(5.0 * i), {0, 0, 0}, {0, 0, 9.81}}));
  EXPECT_TRUE(track.covers(kStart + from_ms(10), kStart + from_ms(150)));
  EXPECT_FALSE(track.covers(kStart + from_ms(150), kStart + from_ms(350)));
  EXPECT_FALSE(track.covers(kStart + from_ms(400), kStart + from_ms(600)));
  EXPECT_FALSE(track.covers(kStart - from_ms(10), kStart + from_ms(100)));
}

TEST(ImuTrack, RefusesWhatIsNotFiniteOrNotNewer) {
  ImuTrack track({});
  EXPECT_TRUE(track.add({kStart, {0, 0, 0}, {0, 0, 9.81}}));
  EXPECT_FALSE(track.add({kStart, {0, 0, 0}, {0, 0, 9.81}}));
  EXPECT_FALSE(track.add({kStart + 1, {NAN, 0, 0}, {0, 0, 9.81}}));
}

TEST(ImuTrack, DriversOfTwoClocksThatTakeTurnsAreOneLine) {
  ImuTrack track({});
  std::vector<std::string> lines;
  log::set_sink([&](log::Level, std::string_view line) { lines.emplace_back(line); });
  for (int turn = 0; turn < 20; ++turn)
    for (int i = 0; i < 5; ++i) {  // the second is twelve seconds behind; the first two of a turn are refused
      const StampNs stamp_ns = kStart + from_ms(5.0 * (5 * turn + i)) - (turn % 2) * from_seconds(12);
      (void)track.add({stamp_ns, {0, 0, 0}, {0, 0, 9.81}});
    }
  log::set_sink({});
  EXPECT_EQ(std::ranges::count(lines, "IMU: its clock was set back by 12.0 s"), 1)
      << testing::PrintToString(lines);
}

/// A driver with a message for each sensor, zeros for the other.
struct Halves {
  void gyro(double ms) { EXPECT_TRUE(track.add({kStart + from_ms(ms), {0.1, 0, 0}, {0, 0, 0}})); }
  void force(double ms, const Eigen::Vector3d& force_m_s2 = {0, 0, 9.81}) {
    EXPECT_TRUE(track.add({kStart + from_ms(ms), {0, 0, 0}, force_m_s2}));
  }
  /// Gyro at 200 Hz, accelerometer at every third of them.
  void both(int from, int to) {
    for (int i = from; i < to; ++i) {
      gyro(5.0 * i);
      if (i % 3 == 0) force(5.0 * i + 2);
    }
  }
  ImuTrack track{ImuTrackOptions{}};
};

TEST(ImuTrack, ABumpThatMergingRepeatsIsNotTheRangesEnd) {
  Halves halves;
  halves.both(0, 30);
  halves.force(151, {0, 0, 16});
  halves.both(31, 60);
  EXPECT_TRUE(halves.track.covers(kStart + from_ms(100), kStart + from_ms(290)));
  EXPECT_THAT(halves.track.problem(kStart + from_ms(295)), testing::Not(testing::HasSubstr("range")));
}

TEST(ImuTrack, TheRangesEndIsNoticedInMergedStreamsAsWell) {
  Halves halves;
  halves.both(0, 30);
  halves.force(151, {0, 0, 19.6});
  halves.gyro(155);
  halves.force(156, {0, 0, 19.6});
  halves.gyro(160);
  EXPECT_THAT(halves.track.problem(kStart + from_ms(160)), testing::HasSubstr("range"));
}

TEST(ImuTrack, AGyroThatStartsFirstDoesNotChangeTheUnit) {
  Halves halves;
  for (int i = 0; i < 18; ++i) halves.gyro(5.0 * i);
  halves.force(87);
  halves.both(18, 300);
  EXPECT_THAT(halves.track.problem(kStart + from_ms(1495)), testing::HasSubstr("merged"));
  EXPECT_NEAR(halves.track.newest().specific_force_m_s2.norm(), 9.81, 1e-9);
}

TEST(ImuTrack, AnAccelerometerThatStopsIsToldAndNotReplayed) {
  Halves halves;
  halves.both(0, 100);
  for (int i = 100; i < 200; ++i) halves.gyro(5.0 * i);
  const StampNs now = kStart + from_ms(995);
  EXPECT_THAT(halves.track.problem(now), testing::HasSubstr("accelerometer has stopped"));
  EXPECT_FALSE(halves.track.covers(now - from_ms(60), now));
  EXPECT_FALSE(halves.track.up(now));
  EXPECT_TRUE(halves.track.covers(kStart + from_ms(100), kStart + from_ms(400)));
  halves.both(200, 400);
  EXPECT_THAT(halves.track.problem(kStart + from_ms(1995)), testing::HasSubstr("merged"));
  EXPECT_TRUE(halves.track.covers(kStart + from_ms(1900), kStart + from_ms(1960)));
  EXPECT_FALSE(halves.track.covers(now - from_ms(60), now)) << "what was missing stays so";
}

TEST(ImuTrack, GravityOfAWrongScaleIsForgottenWithIt) {
  ImuTrack track({.still_seconds = 1});
  for (int i = 0; i < 300; ++i)
    ASSERT_TRUE(track.add({kStart + from_ms(5.0 * i), {0, 0, 0}, {0, 0, i < 240 ? 19.6 : 9.8}}));
  track.begin_anew(Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ());
  const auto motion = track.motion(kStart + from_ms(1350), kStart + from_ms(1450), Eigen::Vector3d::Zero());
  EXPECT_LT(motion.velocity_end_m_s.norm(), 0.01);
}

}  // namespace
}  // namespace liloc
