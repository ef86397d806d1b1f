#pragma once
// Where a device is, between odometry and surfaces: an extended Kalman filter on poses.
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

/// The estimate after a motion that is known to `sd_rad` and `sd_m`.
[[nodiscard]] PoseEstimate carried(const PoseEstimate& before, const Pose& T_before_after, double sd_rad,
                                   double sd_m);

/// Squared distance of the two over their covariances: 6 on average.
[[nodiscard]] double surprise_of(const PoseEstimate& predicted, const PoseEstimate& seen);
constexpr double kMostSurprise = 22.5;  ///< one in a thousand

/// Both weighed by their covariances. Where they contradict each other beyond `surprise_limit`, the prediction
/// was surer of itself than it should have been: it is widened until it no longer does.
[[nodiscard]] PoseEstimate fused(PoseEstimate predicted, const PoseEstimate& seen,
                                 double surprise_limit = kMostSurprise);

}  // namespace liloc
