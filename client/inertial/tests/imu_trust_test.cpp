// An IMU beside what registration measured of the same motion, without frames to match.
#include "client/inertial/imu_trust.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <numbers>
#include <random>

#include "common/testing/box_room.hpp"

namespace liloc {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr StampNs kStart = 1'700'000'000'000'000'000;
using Path = Pose (*)(double);

Pose looking_about(double t) {
  return scene::looking({3 + 0.9 * std::sin(0.7 * t), 2.5 + 0.7 * std::sin(0.9 * t), 1.2},
                        0.6 * std::sin(1.1 * t) + 0.25 * std::sin(2.3 * t), 0.2 + 0.15 * std::sin(1.7 * t));
}
/// A robot that drives slow curves on a level floor.
Pose level(double t) {
  return scene::looking({3 + 0.7 * std::sin(0.4 * t), 2.5 + 0.5 * std::sin(0.55 * t), 0.4},
                        0.5 * std::sin(0.35 * t), 0);
}
/// Turns to and fro, `PeriodMs` long.
template <int PeriodMs>
Pose swaying(double t) {
  return scene::looking({3 + 0.3 * std::sin(0.7 * t), 2.5, 1.2},
                        0.5 * std::sin(2 * std::numbers::pi * 1000 / PeriodMs * t), 0.2);
}
Pose standing(double) {
  return scene::looking({3, 2.5, 1.2}, 0.3, 0.2);
}

Pose mounting() {
  Pose T = Pose::Identity();
  T.linear() = Eigen::Quaterniond(-0.5, 0.5, -0.5, 0.5).toRotationMatrix();
  T.translation() = Eigen::Vector3d(0.01, 0.0, 0.005);
  return T;
}

/// Registration that errs by 2 mm and 1 mrad, and an IMU's samples that come when they are measured.
struct Played {
  explicit Played(Path p) : path(p) {}

  void go(double seconds) {
    const auto samples = scene::imu_along(path, mounting(), t, t + seconds, 200, kStart);
    std::size_t next = 0;
    for (const double end = t + seconds; t < end - 1e-9; t += 1 / frame_hz) {
      for (; next < samples.size() && samples[next].stamp_ns <= kStart + from_seconds(t); ++next) {
        ImuSample sample = samples[next];
        sample.stamp_ns += ahead_ns;
        spoil(sample);
        static_cast<void>(trust.add(sample));
      }
      frame(kStart + from_seconds(t) + frames_ahead_ns);
    }
  }
  void frame(StampNs stamp_ns) {
    std::normal_distribution<double> turn(0, 0.001), shift(0, 0.002);
    Pose T = path(t) * mounting().inverse();
    T.linear() = T.linear() * so3_exp({turn(rng), turn(rng), turn(rng)});
    T.translation() += Eigen::Vector3d(shift(rng), shift(rng), shift(rng));
    trust.saw(stamp_ns, T);
    left_out += trust.believed() == nullptr;
    if (const ImuTrack* track = trust.believed())
      if (const auto up = track->up(stamp_ns)) {
        ++ups;
        wrong_ups += up->dot(T.linear().transpose() * Eigen::Vector3d::UnitZ()) < 0.9;
      }
  }

  Path path;
  double frame_hz = 15, t = 0;
  StampNs ahead_ns = 0;         ///< of the IMU's stamps
  StampNs frames_ahead_ns = 0;  ///< once the frames' clock was set
  std::function<void(ImuSample&)> spoil = [](ImuSample&) {};
  ImuTrust trust{ImuTrackOptions{}};
  int left_out = 0, ups = 0, wrong_ups = 0;  ///< frames
  std::mt19937 rng{1};
};

void invert_force(ImuSample& s) {
  s.specific_force_m_s2 = -s.specific_force_m_s2;
}
void mirror_gyro(ImuSample& s) {
  s.angular_velocity_rad_s = -s.angular_velocity_rad_s;
}
void degrees_per_second(ImuSample& s) {
  s.angular_velocity_rad_s *= 180 / std::numbers::pi;
}
void turn_axes(ImuSample& s) {
  const Eigen::Vector3d w = s.angular_velocity_rad_s;
  s.angular_velocity_rad_s = {w.y(), w.z(), w.x()};
}

class RightImu : public testing::TestWithParam<std::tuple<Path, double>> {};

TEST_P(RightImu, IsBelievedAtAnyRateOfFrames) {
  Played played(std::get<0>(GetParam()));
  played.frame_hz = std::get<1>(GetParam());
  played.go(60);
  EXPECT_EQ(played.left_out, 0);
  EXPECT_EQ(played.trust.problem(), "");
  EXPECT_EQ(played.wrong_ups, 0);
  EXPECT_GT(played.ups, 50);
}
INSTANTIATE_TEST_SUITE_P(Moves, RightImu,
                         testing::Combine(testing::Values(looking_about, level, swaying<1000>, standing),
                                          testing::Values(30.0, 15.0, 5.0, 2.0, 1.0)));

class SlowFrames : public testing::TestWithParam<double> {};

TEST_P(SlowFrames, ShowAGyroThatContradicts) {
  for (const auto spoil : {mirror_gyro, degrees_per_second, turn_axes}) {
    Played played(looking_about);
    played.frame_hz = GetParam();
    played.spoil = spoil;
    played.go(8);
    EXPECT_NE(played.trust.problem(), "");
    EXPECT_EQ(played.trust.believed(), nullptr);
    played.spoil = [](ImuSample&) {};
    played.go(30);
    EXPECT_EQ(played.trust.problem(), "");
  }
}
TEST_P(SlowFrames, NameDegreesPerSecond) {
  Played played(looking_about);
  played.frame_hz = GetParam();
  played.spoil = degrees_per_second;
  played.go(12);
  EXPECT_THAT(played.trust.problem(), HasSubstr("degrees per second"));
}
TEST_P(SlowFrames, ShowAForceThatTurnsWithTheDevice) {
  Played played(looking_about);
  played.frame_hz = GetParam();
  played.spoil = [](ImuSample& s) { s.specific_force_m_s2 *= 1.5; };
  played.go(8);
  EXPECT_THAT(played.trust.problem(), HasSubstr("the accelerometer contradicts the depth"));
}
INSTANTIATE_TEST_SUITE_P(Rates, SlowFrames, testing::Values(1.0, 1.5, 2.0, 3.0));

class InvertedForce : public testing::TestWithParam<std::tuple<Path, double>> {};

TEST_P(InvertedForce, IsNamedAndTakenAgainOnlyWhenItIsRight) {
  Played played(std::get<0>(GetParam()));
  played.frame_hz = std::get<1>(GetParam());
  played.spoil = invert_force;
  played.go(9);
  EXPECT_THAT(played.trust.problem(), HasSubstr("upside down"));
  const int wrong_ups = played.wrong_ups;
  played.go(100);
  EXPECT_EQ(played.wrong_ups, wrong_ups);
  played.spoil = [](ImuSample&) {};
  played.go(15);
  EXPECT_EQ(played.trust.problem(), "");
  EXPECT_EQ(played.wrong_ups, wrong_ups);
}
INSTANTIATE_TEST_SUITE_P(Moves, InvertedForce,
                         testing::Combine(testing::Values(looking_about, level),
                                          testing::Values(15.0, 5.0, 2.0, 1.0)));

TEST(ImuTrust, StrainIsNotForgivenByTimeAlone) {
  Played played(standing);
  played.go(3);
  played.trust.strained();
  played.go(80);
  EXPECT_EQ(played.trust.believed(), nullptr);
  played.path = looking_about;
  played.go(10);
  EXPECT_NE(played.trust.believed(), nullptr);
}

TEST(ImuTrust, AClockThatIsSetWhileTheImuIsLeftOutHarmsNothing) {
  Played played(looking_about);
  played.go(3);
  played.trust.strained();
  played.frames_ahead_ns = played.ahead_ns = -from_seconds(600);
  played.trust.frames_clock_set(played.frames_ahead_ns);
  played.frame(kStart + from_seconds(played.t) + played.frames_ahead_ns);
  EXPECT_EQ(played.trust.believed(), nullptr);  // less than 5 s ago
  played.go(30);
  EXPECT_EQ(played.trust.problem(), "");
  EXPECT_NE(played.trust.believed(), nullptr);
}

TEST(ImuTrust, StrainAtFramesThatAreTooRareToJudgeHarmsNothing) {
  Played played(looking_about);
  played.frame_hz = 0.5;
  played.go(3);
  played.trust.strained();
  played.go(100);
  EXPECT_EQ(played.trust.believed(), nullptr);  // nothing bears it out
}

TEST(ImuTrust, RareFramesThatAreNotFoundWhereItLeadsContradictIt) {
  for (const double frame_hz : {15.0, 2.0}) {
    Played played(looking_about);
    played.frame_hz = frame_hz;
    played.go(3);
    for (int i = 0; i < 3; ++i) {
      EXPECT_NE(played.trust.believed(), nullptr);
      played.trust.saw(kStart + from_seconds(played.t), {}, true);
      played.t += 1 / frame_hz;
    }
    EXPECT_EQ(played.trust.believed() == nullptr, frame_hz < 3)
        << "by the frame before, frequent ones are found";
  }
}

TEST(ImuTrust, APeriodicMotionIsNoOffsetOfClocks) {
  for (const Path path : {Path(swaying<1000>), Path(swaying<1600>), Path(swaying<2400>)}) {
    Played played(path);
    played.spoil = mirror_gyro;
    played.go(40);
    EXPECT_THAT(played.trust.problem(), Not(HasSubstr("stamps are")));
    EXPECT_EQ(played.trust.believed(), nullptr);
  }
}
TEST(ImuTrust, AnOffsetThatCannotBeToldIsNotCorrected) {
  Played played(swaying<1000>);
  played.ahead_ns = from_seconds(0.3);
  played.go(40);
  EXPECT_THAT(played.trust.problem(), Not(HasSubstr("stamps are")));
}
TEST(ImuTrust, AnOffsetIsCorrected) {
  for (const double offset_s : {-0.9, -0.3, 0.3, 0.9}) {
    Played played(looking_about);
    played.ahead_ns = from_seconds(offset_s);
    played.go(20);
    EXPECT_THAT(played.trust.problem(), HasSubstr("corrected"));
    EXPECT_NE(played.trust.believed(), nullptr);
  }
}

}  // namespace
}  // namespace liloc
