#pragma once
// Where a device is, between odometry and surfaces: an extended Kalman filter on poses.
#include "common/geometry/pose_estimate.hpp"

namespace liloc {

/// Both weighed by their covariances. Where they contradict each other beyond `chi_square_limit`, the
/// prediction was surer of itself than it should have been: it is widened until it no longer does.
[[nodiscard]] PoseEstimate fused(PoseEstimate predicted, const PoseEstimate& seen,
                                 double chi_square_limit = kChiSquareLimit);

}  // namespace liloc
