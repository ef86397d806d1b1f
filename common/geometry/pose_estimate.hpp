#pragma once
// A pose with its covariance, and the arithmetic that server and client share.
#include "common/geometry/pose.hpp"

namespace liloc {

/// A pose and how far it may be off, [rad; m] in the sensor's axes.
struct PoseEstimate {
  Pose T_map_sensor = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();

  /// The largest standard deviation in any direction.
  [[nodiscard]] double sd_rad() const;
  [[nodiscard]] double sd_m() const;
};

/// How far `other` is from `T_map_sensor`, [rotation; translation] in the axes of the latter's sensor: the
/// errors that a PoseEstimate's covariance is of.
[[nodiscard]] Vector6d offset_of(const Pose& T_map_sensor, const Pose& other);

/// The estimate after a motion that is known to `sd_rad` and `sd_m`.
[[nodiscard]] PoseEstimate carried(const PoseEstimate& before, const Pose& T_before_after, double sd_rad,
                                   double sd_m);

/// Squared Mahalanobis distance of an offset over its covariance, in the same axes: chi-square of six degrees
/// of freedom, 6 on average, where the covariance is right.
[[nodiscard]] double squared_mahalanobis(const Vector6d& offset, const Matrix6d& covariance);
/// The same of two estimates whose errors are independent.
[[nodiscard]] double squared_mahalanobis(const PoseEstimate& predicted, const PoseEstimate& seen);
constexpr double kChiSquareLimit = 22.5;  ///< of six degrees of freedom, exceeded once in a thousand

}  // namespace liloc
