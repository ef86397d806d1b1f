#pragma once
// Rigid transforms. A name says both frames: p_map = T_map_sensor * p_sensor.
#include <Eigen/Core>
#include <Eigen/Geometry>

#include "common/base/result.hpp"

namespace liloc {

using Pose = Eigen::Isometry3d;
using Vector6d = Eigen::Matrix<double, 6, 1>;  ///< order [rotation (rad); translation (m)]
using Matrix6d = Eigen::Matrix<double, 6, 6>;  ///< same order

/// Exponential of so(3) and its inverse; `so3_log` returns an angle in [0, pi].
[[nodiscard]] Eigen::Matrix3d so3_exp(const Eigen::Vector3d& rotation_rad);
[[nodiscard]] Eigen::Vector3d so3_log(const Eigen::Matrix3d& rotation);
[[nodiscard]] Eigen::Matrix3d skew(const Eigen::Vector3d& v);

/// The registration's retraction: rotation and translation move independently ("pseudo" exponential), so
/// `increment(a) * T` turns about the origin of the left frame and then shifts by the last three numbers.
[[nodiscard]] Pose increment(const Vector6d& a);

/// Linear in translation, constant turn rate in rotation; `share` 0 gives `a`, 1 gives `b`.
[[nodiscard]] Pose interpolate(const Pose& a, const Pose& b, double share);

[[nodiscard]] double rotation_angle_rad(const Pose& T);
/// Angle and distance between two poses of the same sensor (of inverse(a) * b).
[[nodiscard]] double angle_between_rad(const Pose& a, const Pose& b);
[[nodiscard]] double distance_m(const Pose& a, const Pose& b);

/// Brings the rotation back onto SO(3) after many products.
[[nodiscard]] Pose normalized(const Pose& T);

/// A pose from numbers of a file or a wire. `what` names the field in the error: non-finite values, a
/// quaternion off unit length by more than 1e-2 or a translation beyond 1e5 m are refused.
[[nodiscard]] Result<Pose> valid_pose(const Eigen::Vector3d& translation_m,
                                      const Eigen::Vector4d& rotation_xyzw, std::string_view what);

constexpr double degrees(double rad) {
  return rad * 57.29577951308232;
}
constexpr double radians(double deg) {
  return deg / 57.29577951308232;
}

}  // namespace liloc
