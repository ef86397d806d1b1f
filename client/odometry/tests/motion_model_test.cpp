#include "client/odometry/motion_model.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "common/testing/walk.hpp"

namespace liloc {
namespace {

using Eigen::Vector3d;
constexpr double kSeenRad = 1e-4, kSeenM = 1e-4;  // of poses that are measured

/// What carries a device from one pose to the next, frame by frame; each pose is measured.
class Ride {
 public:
  Ride(std::optional<Pose> T_imu_sensor, const Pose& T_odom_start)
      : model(std::move(T_imu_sensor)), T_odom_sensor_(T_odom_start) {}

  [[nodiscard]] FrameStep step(double dt_s) const {
    return {now_ns_, now_ns_ + from_seconds(dt_s), now_ns_, T_odom_sensor_};
  }
  /// The guess of the step, which then ends at `T_odom_sensor`.
  MotionGuess go(double dt_s, const Pose& T_odom_sensor, const ImuTrack* imu = nullptr) {
    const FrameStep next = step(dt_s);
    const MotionGuess guess = model.guess(next, imu);
    model.learn(next, guess, {T_odom_sensor, kSeenRad, kSeenM});
    now_ns_ = next.to_ns;
    T_odom_sensor_ = T_odom_sensor;
    return guess;
  }
  /// With a constant velocity and turn, `frames` of `dt_s`; the error of the last guess, m.
  double cruise(int frames, double dt_s, const Vector3d& velocity_m_s, const Vector3d& turn_rad_s) {
    double error_m = 0;
    for (int i = 0; i < frames; ++i) {
      Pose T = T_odom_sensor_;
      T.linear() = T_odom_sensor_.linear() * so3_exp(turn_rad_s * dt_s);
      T.translation() += velocity_m_s * dt_s;
      error_m = distance_m(go(dt_s, T).T_map_sensor, T);
    }
    return error_m;
  }
  [[nodiscard]] const Pose& at() const { return T_odom_sensor_; }

  MotionModel model;

 private:
  StampNs now_ns_ = test::kStart;
  Pose T_odom_sensor_;
};

constexpr double kDt = 1 / test::kFrameHz;

TEST(MotionModel, WhereNothingIsKnownTheDeviceStays) {
  Ride ride({}, test::walk(0));
  const MotionGuess guess = ride.model.guess(ride.step(kDt), nullptr);
  EXPECT_LT(distance_m(guess.T_map_sensor, test::walk(0)), 1e-12);
  EXPECT_GT(guess.sd_m(), 0.002);
}

TEST(MotionModel, AConstantMotionIsFollowed) {
  Ride ride({}, Pose::Identity());
  EXPECT_LT(ride.cruise(20, kDt, {0.8, -0.3, 0.1}, {0.1, 0.5, -0.2}), 1e-3);
}

TEST(MotionModel, ALongerStepIsInMoreDoubtUpToABound) {
  double last_m = 0;
  for (const double dt : {0.05, 0.1, 0.5, 1.0, 20.0}) {
    Ride ride({}, Pose::Identity());
    ride.cruise(5, kDt, {0.5, 0, 0}, Vector3d::Zero());
    const MotionGuess guess = ride.model.guess(ride.step(dt), nullptr);
    EXPECT_GE(guess.sd_m(), last_m);
    EXPECT_LE(guess.sd_m(), 2 + 1e-9);
    EXPECT_LE(guess.sd_rad(), 1 + 1e-9);
    EXPECT_LT(distance_m(guess.T_map_sensor, ride.at()), 0.6) << "no velocity is believed for over a second";
    last_m = guess.sd_m();
  }
}

TEST(MotionModel, AMotionThatIsNotSeenDiesAway) {
  Ride ride({}, Pose::Identity());
  ride.cruise(20, kDt, {1, 0, 0}, Vector3d::Zero());
  const auto guessed_m = [&] {
    return distance_m(ride.model.guess(ride.step(kDt), nullptr).T_map_sensor, ride.at());
  };
  double last_m = guessed_m();
  EXPECT_NEAR(last_m, kDt, 0.1 * kDt);
  for (int i = 0; i < 15; ++i) {
    ride.model.fade(ride.step(kDt));
    EXPECT_LT(guessed_m(), last_m);
    last_m = guessed_m();
  }
  EXPECT_LT(last_m, 0.1 * kDt) << "after a second";
}

TEST(MotionModel, WhoIsFoundElsewhereOrHaltedIsTakenToStand) {
  for (const bool found : {false, true}) {
    Ride ride({}, Pose::Identity());
    ride.cruise(20, kDt, {1, 0, 0}, {0, 0, 1});
    if (found)
      ride.model.relocated({ride.at(), kSeenRad, kSeenM});
    else
      ride.model.halt();
    const MotionGuess guess = ride.model.guess(ride.step(kDt), nullptr);
    EXPECT_LT(distance_m(guess.T_map_sensor, ride.at()), 1e-9);
    EXPECT_LT(angle_between_rad(guess.T_map_sensor, ride.at()), 1e-9);
  }
}

/// The IMU of the walk, to `to_s`; its gyro told in a unit that is `gyro_unit` rad/s.
ImuTrack track_to(double to_s, double gyro_unit = 1) {
  ImuTrackOptions options;
  options.still_seconds = test::kStillS;
  options.keep_seconds = 100;
  ImuTrack track(options);
  for (ImuSample sample : scene::imu_along(test::walk, test::mounting(), 0, to_s, 200, test::kStart)) {
    sample.angular_velocity_rad_s /= gyro_unit;
    EXPECT_TRUE(track.add(sample));
  }
  return track;
}

/// Errors of the guesses of the walk's second to fourth second, rms in m.
double rms_on_the_walk(bool with_imu) {
  const ImuTrack track = track_to(5);
  Ride ride(test::mounting(), test::walk(0));
  double squares = 0;
  int count = 0;
  for (double t = 0; t + kDt < 4; t += kDt) {
    const Pose T = test::walk(t + kDt);
    const double error_m = distance_m(ride.go(kDt, T, with_imu ? &track : nullptr).T_map_sensor, T);
    if (t < 2) continue;
    squares += error_m * error_m;
    ++count;
  }
  return std::sqrt(squares / count);
}

TEST(MotionModel, AnImuTellsWhatAConstantVelocityMisses) {
  const double with = rms_on_the_walk(true), without = rms_on_the_walk(false);
  EXPECT_LT(with, 1e-3);
  EXPECT_LT(with, 0.5 * without);
}

TEST(MotionModel, AnImuThatFeelsNothingHoldsTheDevice) {
  const ImuTrack track = track_to(0.5);
  ASSERT_TRUE(track.still());
  Ride ride(test::mounting(), test::walk(0));
  const MotionGuess guess = ride.model.guess(ride.step(kDt), &track);
  EXPECT_LT(distance_m(guess.T_map_sensor, test::walk(0)), 1e-12);
  EXPECT_LT(guess.sd_m(), 0.002);
}

/// Rides the walk to `at_s` by sight, and guesses one frame by the IMU.
struct Rivalry {
  Rivalry(const ImuTrack& track, double at_s) : ride(test::mounting(), test::walk(0)) {
    for (double t = 0; t + kDt < at_s; t += kDt) ride.go(kDt, test::walk(t + kDt));
    step = ride.step(kDt);
    guess = ride.model.guess(step, &track);
  }
  Ride ride;
  FrameStep step;
  MotionGuess guess;
};

TEST(MotionModel, AnImuThatIsRightHasNoRival) {
  Rivalry r(track_to(4), 3);
  EXPECT_FALSE(r.ride.model.rival(r.step, r.guess, false));
  EXPECT_FALSE(r.ride.model.rival(r.step, r.guess, true));
}

TEST(MotionModel, AGyroOfAnotherUnitHasOneThatIsRightAndMayBeTaken) {
  Rivalry r(track_to(4, radians(1.0)), 3);  // degrees per second
  const Pose T = test::walk(to_seconds(r.step.to_ns - test::kStart));
  ASSERT_GT(angle_between_rad(r.guess.T_map_sensor, T), 0.15);
  const auto rival = r.ride.model.rival(r.step, r.guess, false);
  ASSERT_TRUE(rival);
  EXPECT_LT(angle_between_rad(rival->T_map_sensor, T), 0.02);
  r.ride.model.take_rival(r.step);
  EXPECT_FALSE(r.ride.model.rival(r.step, *rival, true)) << "it is the guess now";
}

TEST(MotionModel, AVelocityThatIsTooOldIsNoRival) {
  Rivalry r(track_to(4, radians(1.0)), 2);
  FrameStep late = r.step;
  late.to_ns = late.from_ns + from_ms(600);
  EXPECT_FALSE(r.ride.model.rival(late, r.guess, true));
}

}  // namespace
}  // namespace liloc
