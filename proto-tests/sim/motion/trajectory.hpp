#pragma once
// A device's motion: smooth enough (four continuous derivatives) that its IMU can be computed, not guessed.
#include <vector>

#include "common/geometry/pose.hpp"
#include "proto-tests/sim/motion/walk.hpp"

namespace liloc::sim {

/// All in the map frame unless a name says otherwise.
struct MotionState {
  Pose T_map_sensor;
  Eigen::Vector3d velocity_m_s, acceleration_m_s2;
  Eigen::Vector3d turn_rate_sensor_rad_s;  ///< in the sensor's axes
};

class Trajectory {
 public:
  using Vector6 = Eigen::Matrix<double, 6, 1>;

  /// `controls` are x, y, z, yaw, pitch, roll every `step_s`: the control points of a uniform quintic B-spline,
  /// which passes near them and never leaves their hull. At least one; before the first and after the last it
  /// stands.
  Trajectory(std::vector<Vector6> controls, double step_s) : controls_(std::move(controls)), step_s_(step_s) {}

  [[nodiscard]] MotionState at(double time_s) const;

 private:
  std::vector<Vector6> controls_;
  double step_s_;
};

enum class Carriage { hand, wheels };

/// Turns a walk into the motion of a sensor: by hand with gait and a wandering gaze, on wheels level and
/// steady. It is exactly still until `still_s`.
[[nodiscard]] Trajectory sensor_trajectory(Random& random, const Walk& walk, Carriage carriage,
                                           const Eigen::Vector2d& middle, double height_m, double still_s);

}  // namespace liloc::sim
