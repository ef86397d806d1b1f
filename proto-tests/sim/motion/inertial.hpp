#pragma once
// What a device's IMU reads along a trajectory.
#include <functional>

#include "common/geometry/camera.hpp"
#include "proto-tests/sim/base/random.hpp"
#include "proto-tests/sim/motion/trajectory.hpp"

namespace liloc::sim {

constexpr double kGravity_m_s2 = 9.80665;  // the standard one

/// Where the IMU sits in a device: its axes are x forward, y left, z up.
[[nodiscard]] Pose mounted_imu();  // T_imu_sensor

/// The exact reading at a time; specific force includes gravity and the lever arm between sensor and IMU.
[[nodiscard]] ImuSample exact_imu(const Trajectory& trajectory, const Pose& T_imu_sensor, double time_s);

/// Adds white noise and a bias that starts somewhere and walks slowly. Call in order of time.
class ImuErrors {
 public:
  ImuErrors(std::uint64_t seed, std::uint64_t stream, double scale);
  [[nodiscard]] ImuSample spoil(ImuSample sample, double step_s);

 private:
  [[nodiscard]] Eigen::Vector3d normal3() { return {random_.normal(), random_.normal(), random_.normal()}; }
  Random random_;
  double scale_;
  Eigen::Vector3d gyro_bias_, force_bias_;
};

}  // namespace liloc::sim
