#pragma once
#include <Eigen/Core>

#include "common/geometry/pose.hpp"

namespace liloc {

/// How far a pose may be off that is carried on by a velocity where nothing shows the motion: a Kalman filter's
/// covariance of both, without their values. A wrong velocity errs the same way in each frame, so what is not
/// seen grows with time, not with its root. [rotation; translation], odometry axes about the sensor.
class MotionDoubt {
 public:
  /// Everything is known: the map begins here.
  void restart() { P_.setZero(); }
  /// Something else knows how sure the pose is.
  void place(const Matrix6d& covariance);
  /// A step of so many seconds, in which accelerations of these deviations act.
  void predict(double seconds, double accel_sd_m_s2, double turn_sd_rad_s2);
  /// The scene told so much of the pose (information, may be singular) and moved it by `shift`. By how much the
  /// rate was off as well, [rad/s; m/s]: 0 along what the scene did not show. After `predict`.
  [[nodiscard]] Vector6d update(const Matrix6d& scene, const Vector6d& shift);
  [[nodiscard]] Matrix6d pose() const { return P_.topLeftCorner<6, 6>(); }

 private:
  using Matrix12d = Eigen::Matrix<double, 12, 12>;
  Matrix12d P_ = Matrix12d::Zero();  ///< of the pose and its rate
};

}  // namespace liloc
