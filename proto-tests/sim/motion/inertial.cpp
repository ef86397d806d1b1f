#include "proto-tests/sim/motion/inertial.hpp"

#include <cmath>

namespace liloc::sim {
namespace {

using Eigen::Vector3d;
// One sample of a phone-grade IMU at 200 Hz, and how its bias starts and walks.
constexpr double kGyroNoise = 0.003, kForceNoise = 0.04;
constexpr double kGyroBias = 0.003, kForceBias = 0.05;
constexpr double kGyroWalk = 2e-5, kForceWalk = 4e-4;  // per square root of a second
constexpr double kDifference_s = 1e-4;                 // of differences that stand for derivatives

}  // namespace

Pose mounted_imu() {
  Pose T = Pose::Identity();
  T.linear() = Eigen::Quaterniond(-0.5, 0.5, -0.5, 0.5).toRotationMatrix();  // w x y z: optical to body axes
  T.translation() = Vector3d(0.01, 0, 0.005);
  return T;
}

ImuSample exact_imu(const Trajectory& trajectory, const Pose& T_imu_sensor, double time_s) {
  const MotionState now = trajectory.at(time_s);
  const Eigen::Matrix3d R_imu_sensor = T_imu_sensor.linear();
  const Vector3d w = R_imu_sensor * now.turn_rate_sensor_rad_s;
  const Vector3d w_change = R_imu_sensor *
                            (trajectory.at(time_s + kDifference_s).turn_rate_sensor_rad_s -
                             trajectory.at(time_s - kDifference_s).turn_rate_sensor_rad_s) /
                            (2 * kDifference_s);
  const Vector3d lever = -T_imu_sensor.translation();  // from the sensor to the IMU, in the IMU's axes
  const Eigen::Matrix3d R_imu_map = R_imu_sensor * now.T_map_sensor.linear().transpose();
  ImuSample sample;
  sample.angular_velocity_rad_s = w;
  sample.specific_force_m_s2 = R_imu_map * (now.acceleration_m_s2 + Vector3d(0, 0, kGravity_m_s2)) +
                               w_change.cross(lever) + w.cross(w.cross(lever));
  return sample;
}

ImuErrors::ImuErrors(std::uint64_t seed, std::uint64_t stream, double scale)
    : random_(seed, stream),
      scale_(scale),
      gyro_bias_(kGyroBias * scale * normal3()),
      force_bias_(kForceBias * scale * normal3()) {}

ImuSample ImuErrors::spoil(ImuSample sample, double step_s) {
  gyro_bias_ += scale_ * kGyroWalk * std::sqrt(step_s) * normal3();
  force_bias_ += scale_ * kForceWalk * std::sqrt(step_s) * normal3();
  sample.angular_velocity_rad_s += gyro_bias_ + scale_ * kGyroNoise * normal3();
  sample.specific_force_m_s2 += force_bias_ + scale_ * kForceNoise * normal3();
  return sample;
}

}  // namespace liloc::sim
