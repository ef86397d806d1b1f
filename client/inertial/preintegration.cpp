#include "client/inertial/preintegration.hpp"

#include <cassert>
#include <cmath>

namespace liloc {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Matrix9d = Eigen::Matrix<double, 9, 9>;

/// exp(a + d) = exp(a) exp(J d) to first order.
Matrix3d right_jacobian(const Vector3d& a) {
  const double angle = a.norm();
  const Matrix3d K = skew(a);
  if (angle < 1e-5) return Matrix3d::Identity() - 0.5 * K;
  const double squared = angle * angle;
  return Matrix3d::Identity() - (1 - std::cos(angle)) / squared * K +
         (angle - std::sin(angle)) / (squared * angle) * K * K;
}

/// A stretch of constant turn rate `w` and specific force `f`, biases taken off.
void add(Preintegration& p, const Vector3d& w, const Vector3d& f, double dt, const ImuNoise& noise) {
  const Matrix3d half = so3_exp(0.5 * dt * w), whole = half * half;
  const Matrix3d R = p.turn * half;  // at the middle of the stretch
  const Matrix3d turned_force = R * skew(f);
  const Matrix3d middle_by_gyro = half.transpose() * p.turn_by_gyro - 0.5 * dt * right_jacobian(0.5 * dt * w);

  Matrix9d A = Matrix9d::Identity();
  A.block<3, 3>(0, 0) = whole.transpose();
  A.block<3, 3>(3, 0) = -dt * turned_force * half.transpose();
  A.block<3, 3>(6, 0) = -0.5 * dt * dt * turned_force * half.transpose();
  A.block<3, 3>(6, 3) = dt * Matrix3d::Identity();
  p.covariance = A * p.covariance * A.transpose();
  const double gyro = noise.gyro_rad_s_sqrt_hz * noise.gyro_rad_s_sqrt_hz * dt;
  const double accel = noise.accel_m_s2_sqrt_hz * noise.accel_m_s2_sqrt_hz * dt;
  p.covariance.diagonal().segment<3>(0).array() += gyro;
  p.covariance.diagonal().segment<3>(3).array() += accel;
  p.covariance.diagonal().segment<3>(6).array() += 0.25 * accel * dt * dt;

  p.shift_by_accel += dt * p.velocity_by_accel - 0.5 * dt * dt * R;
  p.shift_by_gyro += dt * p.velocity_by_gyro - 0.5 * dt * dt * turned_force * middle_by_gyro;
  p.velocity_by_accel -= dt * R;
  p.velocity_by_gyro -= dt * turned_force * middle_by_gyro;
  p.turn_by_gyro = whole.transpose() * p.turn_by_gyro - dt * right_jacobian(dt * w);

  const Vector3d a = R * f;
  p.shift += p.velocity * dt + 0.5 * dt * dt * a;
  p.velocity += dt * a;
  p.turn = p.turn * whole;
  p.seconds += dt;
}

}  // namespace

Preintegration Preintegration::with(const ImuBias& other) const {
  const Vector3d gyro = other.gyro_rad_s - bias.gyro_rad_s, accel = other.accel_m_s2 - bias.accel_m_s2;
  Preintegration p = *this;
  p.bias = other;
  p.turn = turn * so3_exp(turn_by_gyro * gyro);
  p.velocity = velocity + velocity_by_gyro * gyro + velocity_by_accel * accel;
  p.shift = shift + shift_by_gyro * gyro + shift_by_accel * accel;
  return p;
}

Preintegration preintegrate(const std::vector<ImuSample>& samples, const ImuBias& bias, const ImuNoise& noise) {
  assert(samples.size() >= 2);
  Preintegration p;
  p.bias = bias;
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    const ImuSample &a = samples[i], &b = samples[i + 1];
    const Vector3d w = 0.5 * (a.angular_velocity_rad_s + b.angular_velocity_rad_s) - bias.gyro_rad_s;
    const Vector3d f = 0.5 * (a.specific_force_m_s2 + b.specific_force_m_s2) - bias.accel_m_s2;
    add(p, w, f, to_seconds(b.stamp_ns - a.stamp_ns), noise);
  }
  return p;
}

}  // namespace liloc
