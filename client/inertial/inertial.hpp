#pragma once
// The paper's inertial pipeline (section 5.1.2): smoothing, gravity removal and Algorithm 1. Pure functions.
#include <vector>

#include "common/geometry/camera.hpp"

namespace liloc {

/// One sample without gravity and gyro bias, IMU axes.
struct InertialSample {
  StampNs stamp_ns = 0;
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d acceleration_m_s2 = Eigen::Vector3d::Zero();
};

/// Motion over a span, in the IMU's axes at its start.
struct InertialMotion {
  Pose T_start_end = Pose::Identity();
  Eigen::Vector3d velocity_end_m_s = Eigen::Vector3d::Zero();  ///< axes at the start
};

/// Algorithm 1: double integration, acceleration and rate constant between two samples. The paper turns
/// velocity and acceleration together and multiplies rotations on the left, which holds to first order; here
/// velocity stays in the axes of the start and rotations are body rates, so that a circle closes. At least two
/// samples; the last one only ends the span. `velocity_m_s`: at the start, in the axes of the start.
[[nodiscard]] InertialMotion initial_transform(const std::vector<InertialSample>& samples,
                                               const Eigen::Vector3d& velocity_m_s);

/// Gaussian filter along the sequence (the paper: standard deviation 2 samples, cut at 3 deviations); at the
/// ends the kernel is cut and made to sum to 1.
[[nodiscard]] std::vector<Eigen::Vector3d> gaussian_smoothed(const std::vector<Eigen::Vector3d>& values,
                                                             double sd_samples);
/// Centred moving average over `window` samples (odd), shorter at the ends.
[[nodiscard]] std::vector<Eigen::Vector3d> moving_average(const std::vector<Eigen::Vector3d>& values,
                                                          int window);

}  // namespace liloc
