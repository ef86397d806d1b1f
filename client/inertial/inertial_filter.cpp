#include "client/inertial/inertial_filter.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace liloc {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// On Earth, and what the accelerometer's scale adds; by hand.
constexpr double kEarth = 9.81, kEarthSd = 0.03;
constexpr double kAccelBiasSd = 0.1;                   // m/s^2, at the start; by hand
constexpr double kGyroWalk = 5e-5, kAccelWalk = 1e-3;  // of the biases per square root of a second; by hand
// Per span: clocks of camera and IMU, their mounting. By hand.
constexpr double kMountSdRad = 2e-4, kMountSdM = 5e-4;
// Strain beyond which the predictions are doubted, and by which they are doubted in full: people push a device
// about with so many m/s^2 and rad/s^2. It never came to 2 in 33 walks (DECISIONS.md); the rest by hand.
constexpr double kMostStrain = 2, kFullDoubt = 6, kDoubtAccel = 4, kDoubtTurn = 10;
// A new IMU may send another unit: it is doubted in full at first, and no more after a second of matches (14 at
// 15 frames a second) that support it; by hand.
constexpr double kProving = 0.85, kProven = 0.1;
// s; over longer steps nothing but the IMU leads to a match; by hand.
constexpr double kLongestDoubted = 0.4;
constexpr double kFade = 0.9;  // of the strain, per measurement; by hand
// In rad/s and m/s^2: what no sensor in order has; by hand.
constexpr double kMostGyroBias = 0.1, kMostAccelBias = 0.5;
constexpr double kPlacedSdRad = 0.01, kPlacedSdM = 0.02;  // of a pose that was found anew; by hand

}  // namespace

InertialFilter::InertialFilter(const InertialStart& start) {
  const Matrix3d R = start.T_odom_imu.linear();
  state_.T_odom_imu = start.T_odom_imu;
  state_.velocity_m_s = start.velocity_m_s;
  state_.bias.gyro_rad_s = start.gyro_bias_rad_s;
  state_.gravity_m_s2 = -(R * start.force_m_s2);
  forget(kTurn, 1e-4);
  forget(kPlace, 1e-4);
  forget(kVelocity, start.velocity_sd_m_s);
  forget(kGyroBias, start.gyro_bias_sd_rad_s);
  forget(kAccelBias, kAccelBiasSd);
  // At rest the accelerometer reads gravity and bias together: f = -R^T g + b.
  const double variance = kAccelBiasSd * kAccelBiasSd;
  forget(kGravity, std::sqrt(variance + start.force_sd_m_s2 * start.force_sd_m_s2));
  P_.block<3, 3>(kGravity, kAccelBias) = variance * R;
  P_.block<3, 3>(kAccelBias, kGravity) = variance * R.transpose();
  // Gravity's size is known, which tells the bias along it.
  Eigen::Matrix<double, 1, 18> h = Eigen::Matrix<double, 1, 18>::Zero();
  h.segment<3>(kGravity) = state_.gravity_m_s2.normalized().transpose();
  const double innovation = kEarth - state_.gravity_m_s2.norm();
  const double spread = (h * P_ * h.transpose()).value() + kEarthSd * kEarthSd;
  const Eigen::Matrix<double, 18, 1> gain = P_ * h.transpose() / spread;
  apply(gain * innovation);
  P_ = (P_ - gain * h * P_).eval();
}

void InertialFilter::forget(int block, double sd) {
  P_.middleRows<3>(block).setZero();
  P_.middleCols<3>(block).setZero();
  P_.block<3, 3>(block, block) = sd * sd * Matrix3d::Identity();
}

void InertialFilter::apply(const Eigen::Matrix<double, 18, 1>& error) {
  state_.T_odom_imu.linear() = so3_exp(error.segment<3>(kTurn)) * state_.T_odom_imu.linear();
  state_.T_odom_imu.translation() += error.segment<3>(kPlace);
  state_.velocity_m_s += error.segment<3>(kVelocity);
  state_.bias.gyro_rad_s += error.segment<3>(kGyroBias);
  state_.bias.accel_m_s2 += error.segment<3>(kAccelBias);
  state_.gravity_m_s2 += error.segment<3>(kGravity);
  const auto bounded = [](const Vector3d& bias, double most) {
    return Vector3d(bias.cwiseMax(-most).cwiseMin(most));
  };
  state_.bias.gyro_rad_s = bounded(state_.bias.gyro_rad_s, kMostGyroBias);
  state_.bias.accel_m_s2 = bounded(state_.bias.accel_m_s2, kMostAccelBias);
}

void InertialFilter::predict(const std::vector<ImuSample>& samples) {
  const ImuNoise noise;
  const Preintegration p = preintegrate(samples, state_.bias, noise);
  const double t = p.seconds;
  const Matrix3d R = state_.T_odom_imu.linear(), R_end = R * p.turn;
  Matrix18d F = Matrix18d::Identity();
  F.block<3, 3>(kTurn, kGyroBias) = R_end * p.turn_by_gyro;
  F.block<3, 3>(kVelocity, kTurn) = -skew(R * p.velocity);
  F.block<3, 3>(kVelocity, kGyroBias) = R * p.velocity_by_gyro;
  F.block<3, 3>(kVelocity, kAccelBias) = R * p.velocity_by_accel;
  F.block<3, 3>(kVelocity, kGravity) = t * Matrix3d::Identity();
  F.block<3, 3>(kPlace, kTurn) = -skew(R * p.shift);
  F.block<3, 3>(kPlace, kVelocity) = t * Matrix3d::Identity();
  F.block<3, 3>(kPlace, kGyroBias) = R * p.shift_by_gyro;
  F.block<3, 3>(kPlace, kAccelBias) = R * p.shift_by_accel;
  F.block<3, 3>(kPlace, kGravity) = 0.5 * t * t * Matrix3d::Identity();
  Eigen::Matrix<double, 18, 9> G = Eigen::Matrix<double, 18, 9>::Zero();
  G.block<3, 3>(kTurn, 0) = R_end;
  G.block<3, 3>(kVelocity, 3) = R;
  G.block<3, 3>(kPlace, 6) = R;
  P_ = F * P_ * F.transpose() + G * p.covariance * G.transpose();
  const Vector3d pushed = p.velocity + R.transpose() * state_.gravity_m_s2 * t;  // without gravity
  const double turn_sd = kMountSdRad + noise.gyro_scale * so3_log(p.turn).norm();
  const double push_sd = noise.accel_scale * pushed.norm();
  P_.diagonal().segment<3>(kTurn).array() += turn_sd * turn_sd;
  P_.diagonal().segment<3>(kPlace).array() += kMountSdM * kMountSdM;
  P_.diagonal().segment<3>(kVelocity).array() += push_sd * push_sd;
  P_.diagonal().segment<3>(kGyroBias).array() += kGyroWalk * kGyroWalk * t;
  P_.diagonal().segment<3>(kAccelBias).array() += kAccelWalk * kAccelWalk * t;

  const double share = std::clamp((strain() - kMostStrain) / kFullDoubt, 0.0, 1.0);
  if (share > 0) doubt(t, share * kDoubtAccel, share * kDoubtTurn);
  if (unproven_ > share && t < kLongestDoubted) doubt(t, unproven_ * kDoubtAccel, unproven_ * kDoubtTurn);

  state_.T_odom_imu.translation() += t * state_.velocity_m_s + 0.5 * t * t * state_.gravity_m_s2 + R * p.shift;
  state_.velocity_m_s += t * state_.gravity_m_s2 + R * p.velocity;
  state_.T_odom_imu.linear() = R_end;
  state_.T_odom_imu = normalized(state_.T_odom_imu);
}

void InertialFilter::update(const Pose& T_odom_imu, const Matrix6d& covariance) {
  Vector6d shift;
  shift.head<3>() = so3_log(T_odom_imu.linear() * state_.T_odom_imu.linear().transpose());
  shift.tail<3>() = T_odom_imu.translation() - state_.T_odom_imu.translation();
  const Matrix6d prior = P_.topLeftCorner<6, 6>(), certainty = prior.inverse();
  nis_ = kFade * nis_ + shift.dot(certainty * shift);
  expected_nis_ = kFade * expected_nis_ + 6 - (certainty * covariance).trace();
  if (strain() < kMostStrain) unproven_ = unproven_ > kProven ? kProving * unproven_ : 0;
  // What is correlated with the pose follows it: regression of the state on the pose's error.
  const Eigen::Matrix<double, 18, 6> gain = P_.leftCols<6>() * certainty;
  apply(gain * shift);
  state_.T_odom_imu = T_odom_imu;
  P_ += gain * (covariance - prior) * gain.transpose();
  P_ = (0.5 * (P_ + P_.transpose())).eval();
}

/// As if accelerations had acted that the IMU did not feel.
void InertialFilter::doubt(double seconds, double accel_sd_m_s2, double turn_sd_rad_s2) {
  const double moved = 0.5 * seconds * seconds * accel_sd_m_s2, sped = seconds * accel_sd_m_s2;
  const double turned = 0.5 * seconds * seconds * turn_sd_rad_s2;
  P_.diagonal().segment<3>(kTurn).array() += turned * turned;
  P_.diagonal().segment<3>(kPlace).array() += moved * moved;
  P_.diagonal().segment<3>(kVelocity).array() += sped * sped;
  P_.block<3, 3>(kPlace, kVelocity).diagonal().array() += moved * sped;
  P_.block<3, 3>(kVelocity, kPlace).diagonal().array() += moved * sped;
}

void InertialFilter::stop(double velocity_sd_m_s) {
  state_.velocity_m_s.setZero();
  auto variances = P_.diagonal().segment<3>(kVelocity);
  variances = variances.cwiseMax(velocity_sd_m_s * velocity_sd_m_s).eval();
}

void InertialFilter::loosen(double velocity_sd_m_s, double accel_sd_m_s2) {
  P_.diagonal().segment<3>(kVelocity).array() += velocity_sd_m_s * velocity_sd_m_s;
  P_.diagonal().segment<3>(kGravity).array() += accel_sd_m_s2 * accel_sd_m_s2;
}

void InertialFilter::place(const Pose& T_odom_imu, const Vector3d& velocity_m_s, double velocity_sd_m_s) {
  state_.T_odom_imu = T_odom_imu;
  state_.velocity_m_s = velocity_m_s;
  forget(kTurn, kPlacedSdRad);
  forget(kPlace, kPlacedSdM);
  forget(kVelocity, velocity_sd_m_s);
}

}  // namespace liloc
