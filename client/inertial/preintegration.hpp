#pragma once
// On-manifold preintegration (Forster, Carlone, Dellaert, Scaramuzza, "On-Manifold Preintegration for Real-Time
// Visual-Inertial Odometry", 2017). Pure functions.
#include <vector>

#include "common/geometry/camera.hpp"

namespace liloc {

struct ImuBias {
  Eigen::Vector3d gyro_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_m_s2 = Eigen::Vector3d::Zero();
};

/// Defaults: a phone-grade IMU with a tenth to spare for what a model of white noise leaves out.
struct ImuNoise {
  double gyro_rad_s_sqrt_hz = 3e-4;  ///< density of the white noise
  double accel_m_s2_sqrt_hz = 6e-3;
  double gyro_scale = 0.003;  ///< error of the scale and of the axes, as a share of the turn over the span
  double accel_scale = 0.01;  ///< the same, as a share of the change of velocity
};

/// What an IMU felt over a span, in its axes at the start, gravity still inside:
///   R_to = R_from turn, v_to = v_from + g t + R_from velocity, p_to = p_from + v_from t + g t^2 / 2 + R_from
///   shift
struct Preintegration {
  double seconds = 0;
  ImuBias bias;  ///< that was taken off the samples
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();  ///< m/s
  Eigen::Vector3d shift = Eigen::Vector3d::Zero();     ///< m
  /// First-order change with the biases; of the turn on its right, in the axes at the end.
  Eigen::Matrix3d turn_by_gyro = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d velocity_by_gyro = Eigen::Matrix3d::Zero(), velocity_by_accel = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d shift_by_gyro = Eigen::Matrix3d::Zero(), shift_by_accel = Eigen::Matrix3d::Zero();
  /// Of the errors [turn (axes at the end); velocity; shift].
  Eigen::Matrix<double, 9, 9> covariance = Eigen::Matrix<double, 9, 9>::Zero();

  /// The same with other biases, to first order.
  [[nodiscard]] Preintegration with(const ImuBias& other) const;
};

/// Between the first and the last of at least two samples in order of time; between neighbours their mean
/// counts.
[[nodiscard]] Preintegration preintegrate(const std::vector<ImuSample>& samples, const ImuBias& bias,
                                          const ImuNoise& noise = {});

}  // namespace liloc
