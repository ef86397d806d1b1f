#include "client/src/motion_model.hpp"

#include <algorithm>
#include <cmath>

namespace liloc {
namespace {

constexpr double kAccelSd = 4.0;                        // m/s^2: how hard people push a device about
constexpr double kTurnAccelSd = 10.0;                   // rad/s^2: the same in rotation, where no gyro tells
constexpr double kImuAccelSd = 0.4;                     // m/s^2: what is left of it after the accelerometer
constexpr double kVelocitySd = 0.05;                    // m/s: of the velocity that a guess starts from
constexpr double kGyroSd = 0.004;                       // rad/s: noise, bias and timing together
constexpr double kStillSdRad = 1e-4, kStillSdM = 1e-3;  // of a frame's motion while the device stands still
constexpr double kFadingS =
    0.4;  // without an IMU a motion that is no longer seen dies away with this time constant
constexpr StampNs kLongestStepNs = from_ms(1000);

}  // namespace

MotionGuess MotionModel::by_imu(const FrameStep& step, const ImuTrack& imu) {
  if (imu.still()) {
    halt();
    return {step.T_odom_from, kStillSdRad, kStillSdM};
  }
  const Pose T_odom_imu = step.T_odom_from * T_imu_sensor_->inverse();
  const Eigen::Matrix3d R = T_odom_imu.linear();
  const InertialMotion motion = imu.motion(step.from_ns, step.to_ns, R.transpose() * velocity_imu_odom_);
  velocity_imu_odom_ = R * motion.velocity_end_m_s;
  const double blind = to_seconds(step.to_ns - step.anchored_ns);
  MotionGuess guess;
  guess.T_map_sensor = T_odom_imu * motion.T_start_end * *T_imu_sensor_;
  guess.sd_rad = 2e-4 + kGyroSd * blind;
  guess.sd_m = 0.002 + kVelocitySd * blind + 0.5 * kImuAccelSd * blind * blind;
  return guess;
}

MotionGuess MotionModel::guess(const FrameStep& step, const ImuTrack* imu) {
  by_imu_ = imu != nullptr && imu->covers(step.from_ns, step.to_ns);
  if (by_imu_) return by_imu(step, *imu);
  const double dt = to_seconds(std::min(step.to_ns - step.from_ns, kLongestStepNs));
  const double blind = to_seconds(step.to_ns - step.anchored_ns);
  MotionGuess guess;
  guess.T_map_sensor.linear() = step.T_odom_from.linear() * so3_exp(turn_rate_ * dt);
  guess.T_map_sensor.translation() = step.T_odom_from.translation() + velocity_odom_ * dt;
  guess.sd_rad = std::min(0.5, 0.003 + 0.5 * kTurnAccelSd * blind * blind);
  guess.sd_m = std::min(1.0, 0.002 + kVelocitySd * blind + 0.5 * kAccelSd * blind * blind);
  return guess;
}

void MotionModel::learn(const FrameStep& step, const MotionGuess& guess, const Pose& T_odom_to) {
  const double dt = to_seconds(step.to_ns - step.from_ns);
  velocity_odom_ = (T_odom_to.translation() - step.T_odom_from.translation()) / dt;
  turn_rate_ = so3_log(step.T_odom_from.linear().transpose() * T_odom_to.linear()) / dt;
  if (!T_imu_sensor_) return;
  // Algorithm 1 takes the velocity back from the refined transform. Only its error is taken here, so that the
  // acceleration within the step, which the guess knows, is not averaged away.
  const auto imu_at = [&](const Pose& T_odom_sensor) {
    return Eigen::Vector3d((T_odom_sensor * T_imu_sensor_->inverse()).translation());
  };
  if (by_imu_)
    velocity_imu_odom_ += (imu_at(T_odom_to) - imu_at(guess.T_map_sensor)) / dt;
  else
    velocity_imu_odom_ = (imu_at(T_odom_to) - imu_at(step.T_odom_from)) / dt;
}

void MotionModel::fade(const FrameStep& step) {
  if (by_imu_) return;
  const double left = std::exp(-to_seconds(step.to_ns - step.from_ns) / kFadingS);
  velocity_odom_ *= left;
  turn_rate_ *= left;
}

void MotionModel::halt() {
  velocity_odom_ = velocity_imu_odom_ = turn_rate_ = Eigen::Vector3d::Zero();
}

}  // namespace liloc
