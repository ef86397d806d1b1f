#pragma once
#include "common/registration/target/target.hpp"

namespace liloc {

/// What is not noise of single points and so does not average out.
/// Defaults are by hand where nothing else is said.
struct CovarianceOptions {
  double max_pair_distance_m = 0.08;  ///< as refinement's last
  double min_normal_agreement = 0.5;
  /// Points nearer to each other share their errors (of greatest likelihood, DECISIONS.md) ...
  double patch_m = 0.4;
  double patch_bias_m = 0.001;   ///< ... and this one besides what their residuals show (likewise)
  double common_bias_m = 0.001;  ///< of all points alike: calibration, voxels, a sensor's range
  /// Of surroundings outside the frame's view: the device placed them by its odometry.
  double surroundings_sd_rad = radians(0.03), surroundings_sd_m = 0.002;
  double most_rad = 1, most_m = 1;  ///< where nothing is observed
};

/// How far a refined pose may be off: one observation per patch of surface rather than per point, since
/// neighbours err alike. Each patch weighs in with its mean residual and bias (White's estimator over
/// clusters); what normals seem to observe by their noise alone is taken out. In the source's axes, [rad; m].
/// Pure.
[[nodiscard]] Matrix6d pose_covariance(const Target& target, const Query& query, const Pose& T_target_source,
                                       const CovarianceOptions& options = {});

}  // namespace liloc
