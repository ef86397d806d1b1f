#include "client/odometry/motion_doubt.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace liloc {
namespace {

constexpr double kMostSpeedSd = 1, kMostTurnSd = 1.5;  // m/s, rad/s: devices that people carry; by hand

}  // namespace

void MotionDoubt::place(const Matrix6d& covariance) {
  P_.setZero();
  P_.topLeftCorner<6, 6>() = covariance;
}

void MotionDoubt::predict(double seconds, double accel_sd_m_s2, double turn_sd_rad_s2) {
  Matrix12d F = Matrix12d::Identity();
  F.topRightCorner<6, 6>() = seconds * Matrix6d::Identity();
  Eigen::Matrix<double, 12, 6> G;
  // As if the rate changed at the step's start, so that a pose that is seen tells its mean over the step.
  G << 0.5 * seconds * seconds * Matrix6d::Identity(), 0.5 * seconds * Matrix6d::Identity();
  G.leftCols<3>() *= turn_sd_rad_s2;
  G.rightCols<3>() *= accel_sd_m_s2;
  P_ = F * P_ * F.transpose() + G * G.transpose();
  for (int i = 6; i < 12; ++i) {
    const double most = i < 9 ? kMostTurnSd : kMostSpeedSd;
    const double scale = std::min(1.0, most / std::sqrt(std::max(P_(i, i), 1e-12)));
    P_.row(i) *= scale;
    P_.col(i) *= scale;
  }
}

Vector6d MotionDoubt::update(const Matrix6d& scene, const Vector6d& shift) {
  const Matrix6d prior = pose(), certainty = prior.inverse();
  const Matrix6d covariance = (scene + certainty).inverse();
  const Eigen::Matrix<double, 12, 6> gain = P_.leftCols<6>() * certainty;
  P_ += gain * (covariance - prior) * gain.transpose();
  P_ = (0.5 * (P_ + P_.transpose())).eval();
  return gain.bottomRows<6>() * shift;
}

}  // namespace liloc
