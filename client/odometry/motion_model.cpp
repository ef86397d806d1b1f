#include "client/odometry/motion_model.hpp"

#include <algorithm>
#include <cmath>

namespace liloc {
namespace {

// By hand, where nothing else is said.
// Of the first, 1 and 2 lost (common/registration/scan/DECISIONS.md).
constexpr double kAccelSd = 4.0;                        // m/s^2: how hard people push a device about
constexpr double kTurnAccelSd = 10.0;                   // rad/s^2: the same in rotation, where no gyro tells
constexpr double kStepSdRad = 0.003, kStepSdM = 0.002;  // of a guess without an IMU, at least ...
constexpr double kMostSdRad = 1, kMostSdM = 2;          // ... and at most; by hand
// In m/s^2: what is left of it after the accelerometer; by hand.
constexpr double kImuAccelSd = 0.4;
constexpr double kImuTurnAccelSd = 0.06;  // rad/s^2: the same after the gyro, in 15 frames a second; by hand
constexpr double kVelocitySd = 0.05;      // m/s: of the velocity that a guess starts from; by hand
constexpr double kGyroSd = 0.004;         // rad/s: noise, bias and timing together; by hand
constexpr double kStillSdRad = 1e-4, kStillSdM = 1e-3;  // of a frame's motion while the device stands still
constexpr double kFadingS =
    0.4;  // without an IMU a motion that is no longer seen dies away with this time constant
constexpr double kGravity = 9.81;  // m/s^2, on Earth
// What the filter starts from: m/s, rad/s, m/s^2. By hand.
constexpr double kStoodVelocitySd = 0.05, kUnknownVelocitySd = 0.5;
constexpr double kCalibratedGyroSd = 5e-4, kCalibratedForceSd = 0.03;  // after standing still
// What a blind stretch shows of the errors of velocity and gravity that matches had left:
// client/inertial/DECISIONS.md.
constexpr double kBlindVelocitySd = 0.04, kBlindAccelSd = 0.05;
// A frame's motion that nobody makes, and that a match hardly corrects; by hand.
constexpr double kRivalRad = 0.15, kRivalM = 0.15;
constexpr StampNs kLongestRivalNs = from_ms(400);  // a velocity that is older predicts nothing; by hand
constexpr double kFailedShare = 0.2;               // of it, where no match was found; by hand
// Of a frame to the next, over which a velocity still says something; by hand.
constexpr StampNs kLongestStepNs = from_ms(1000);

/// Turns errors of the IMU's pose into errors of the sensor's, odometry axes: `lever` leads from the sensor to
/// the IMU.
Matrix6d sensor_of_imu(const Eigen::Vector3d& lever) {
  Matrix6d M = Matrix6d::Identity();
  M.bottomLeftCorner<3, 3>() = skew(lever);
  return M;
}

}  // namespace

MotionGuess MotionModel::guess(const FrameStep& step, const ImuTrack* imu) {
  by_imu_ = imu != nullptr && imu->covers(step.from_ns, step.to_ns);
  doubt_before_ = doubt_;
  if (imu == nullptr) {  // what a filter learned from an IMU that is left out may be wrong
    filter_.reset();
    stood_still_ = false;
  }
  if (!by_filter())
    doubt_.predict(to_seconds(step.to_ns - step.from_ns), by_imu_ ? kImuAccelSd : kAccelSd,
                   by_imu_ ? kImuTurnAccelSd : kTurnAccelSd);
  const MotionGuess guess = by_imu_ ? by_imu(step, *imu) : by_constant_velocity(step, doubt_);
  if (by_filter()) doubt_.place(guess.covariance);
  return guess;
}

MotionDoubt MotionModel::doubt_without_imu(const FrameStep& step) const {
  MotionDoubt doubt = doubt_before_;
  doubt.predict(to_seconds(step.to_ns - step.from_ns), kAccelSd, kTurnAccelSd);
  return doubt;
}

std::optional<MotionGuess> MotionModel::rival(const FrameStep& step, const MotionGuess& guess,
                                              bool failed) const {
  if (!by_imu_ || step.to_ns - step.from_ns > kLongestRivalNs) return std::nullopt;
  const MotionGuess other = by_constant_velocity(step, doubt_without_imu(step));
  const double share = failed ? kFailedShare : 1;
  if (angle_between_rad(other.T_map_sensor, guess.T_map_sensor) < share * kRivalRad &&
      distance_m(other.T_map_sensor, guess.T_map_sensor) < share * kRivalM)
    return std::nullopt;
  return other;
}

void MotionModel::take_rival(const FrameStep& step) {
  doubt_ = doubt_without_imu(step);
  by_imu_ = false;
  filter_ns_ = 0;
}

MotionGuess MotionModel::by_constant_velocity(const FrameStep& step, const MotionDoubt& doubt) const {
  const double dt = to_seconds(std::min(step.to_ns - step.from_ns, kLongestStepNs));
  Pose T = Pose::Identity();
  T.linear() = step.T_odom_from.linear() * so3_exp(turn_rate_ * dt);
  T.translation() = step.T_odom_from.translation() + velocity_odom_ * dt;
  Matrix6d covariance = doubt.pose();
  covariance.diagonal().head<3>().array() += kStepSdRad * kStepSdRad;
  covariance.diagonal().tail<3>().array() += kStepSdM * kStepSdM;
  const MotionGuess guess(T, covariance);
  Vector6d scale = Vector6d::Constant(std::min(1.0, kMostSdM / guess.sd_m()));
  scale.head<3>().setConstant(std::min(1.0, kMostSdRad / guess.sd_rad()));
  return {T, Matrix6d(scale.asDiagonal() * covariance * scale.asDiagonal())};
}

MotionGuess MotionModel::by_imu(const FrameStep& step, const ImuTrack& imu) {
  if (imu.still()) {
    halt();
    stood_still_ = true;
    return {step.T_odom_from, kStillSdRad, kStillSdM};
  }
  return method_ == InertialMethod::preintegration ? by_preintegration(step, imu) : by_algorithm1(step, imu);
}

MotionGuess MotionModel::by_algorithm1(const FrameStep& step, const ImuTrack& imu) {
  const Pose T_odom_imu = step.T_odom_from * T_imu_sensor_->inverse();
  const Eigen::Matrix3d R = T_odom_imu.linear();
  const InertialMotion motion = imu.motion(step.from_ns, step.to_ns, R.transpose() * velocity_imu_odom_);
  velocity_imu_odom_ = R * motion.velocity_end_m_s;
  const double blind = to_seconds(step.to_ns - step.anchored_ns);
  return {T_odom_imu * motion.T_start_end * *T_imu_sensor_, 2e-4 + kGyroSd * blind,
          0.002 + kVelocitySd * blind + 0.5 * kImuAccelSd * blind * blind};
}

void MotionModel::start_filter(const FrameStep& step, const ImuTrack& imu) {
  InertialStart start;
  start.T_odom_imu = step.T_odom_from * T_imu_sensor_->inverse();
  start.velocity_m_s = velocity_odom_;
  if (stood_still_) start.velocity_sd_m_s = kStoodVelocitySd;
  start.gyro_bias_rad_s = imu.gyro_bias_rad_s();
  start.force_m_s2 = kGravity * imu.up(step.from_ns).value_or(Eigen::Vector3d::UnitZ());
  if (imu.calibrated()) {
    start.gyro_bias_sd_rad_s = kCalibratedGyroSd;
    start.force_m_s2 = imu.resting_force_m_s2();
    start.force_sd_m_s2 = kCalibratedForceSd;
  }
  filter_.emplace(start);
}

MotionGuess MotionModel::by_preintegration(const FrameStep& step, const ImuTrack& imu) {
  if (!filter_) {
    start_filter(step, imu);
  } else if (filter_ns_ != step.from_ns) {  // a gap in the samples
    filter_->place(step.T_odom_from * T_imu_sensor_->inverse(), velocity_odom_, kUnknownVelocitySd);
    filter_->widen(doubt_.pose());
  }
  filter_->predict(imu.samples(step.from_ns, step.to_ns));
  filter_ns_ = step.to_ns;
  const Pose T = filter_->state().T_odom_imu * *T_imu_sensor_;
  const Matrix6d M = sensor_of_imu(T.linear() * T_imu_sensor_->inverse().translation());
  return {T, Matrix6d(M * filter_->covariance().topLeftCorner<6, 6>() * M.transpose())};
}

void MotionModel::learn(const FrameStep& step, const MotionGuess& guess, const MotionGuess& measured) {
  const Pose& T = measured.T_map_sensor;
  const Pose T_sensor_imu = T_imu_sensor_ ? T_imu_sensor_->inverse() : Pose::Identity();
  if (by_filter()) {
    const Matrix6d M = sensor_of_imu(T.linear() * T_sensor_imu.translation()).inverse();
    filter_->update(T * T_sensor_imu, M * measured.covariance * M.transpose());
    doubt_.place(measured.covariance);
  }
  Vector6d shift, rate = Vector6d::Zero();
  shift << so3_log(T.linear() * guess.T_map_sensor.linear().transpose()),
      T.translation() - guess.T_map_sensor.translation();
  if (!by_filter()) rate = doubt_.update(measured.covariance.inverse() - guess.covariance.inverse(), shift);
  if (step.anchored_ns != step.from_ns) return;  // the step began at a guess
  const double dt = to_seconds(step.to_ns - step.from_ns);
  if (by_imu_) {
    velocity_odom_ = (T.translation() - step.T_odom_from.translation()) / dt;
    turn_rate_ = so3_log(step.T_odom_from.linear().transpose() * T.linear()) / dt;
  } else {
    velocity_odom_ += rate.tail<3>();
    turn_rate_ += T.linear().transpose() * rate.head<3>();
  }
  // Algorithm 1 takes the velocity back from the refined transform. Only its error is taken here, so that the
  // acceleration within the step, which the guess knows, is not averaged away.
  const auto imu_at = [&](const Pose& T_odom_sensor) {
    return Eigen::Vector3d((T_odom_sensor * T_sensor_imu).translation());
  };
  if (by_imu_)
    velocity_imu_odom_ += (imu_at(T) - imu_at(guess.T_map_sensor)) / dt;
  else
    velocity_imu_odom_ = (imu_at(T) - imu_at(step.T_odom_from)) / dt;
}

void MotionModel::relocated(const MotionGuess& measured) {
  doubt_.place(measured.covariance);
  velocity_odom_ = velocity_imu_odom_ = turn_rate_ = Eigen::Vector3d::Zero();
  if (filter_)
    filter_->place(measured.T_map_sensor * T_imu_sensor_->inverse(), velocity_odom_, kUnknownVelocitySd);
}

void MotionModel::fade(const FrameStep& step) {
  if (by_filter() && step.anchored_ns == step.from_ns) filter_->loosen(kBlindVelocitySd, kBlindAccelSd);
  if (by_imu_) return;
  const double left = std::exp(-to_seconds(step.to_ns - step.from_ns) / kFadingS);
  velocity_odom_ *= left;
  turn_rate_ *= left;
}

void MotionModel::restart() {
  halt();
  if (filter_) filter_->place(filter_->state().T_odom_imu, Eigen::Vector3d::Zero(), kUnknownVelocitySd);
  doubt_.restart();
}

void MotionModel::halt() {
  if (filter_) filter_->stop(kUnknownVelocitySd);
  velocity_odom_ = velocity_imu_odom_ = turn_rate_ = Eigen::Vector3d::Zero();
}

}  // namespace liloc
