#pragma once
#include <cstdint>

#include "common/registration/spot/align_evidence.hpp"

namespace liloc {

/// Defaults are by hand where nothing else is said.
struct AlignOptions {
  double voxel_size_m = 0.05;  ///< 0.005..1
  double risk = 0.05;    ///< a pose is trusted if it is wrong with no greater probability; over 0, under 1
  bool gravity = false;  ///< both clouds have z up: only x, y, z and yaw are searched
  std::uint64_t seed = 1;
  int threads = 1;
  Describer describer = {};  ///< of points; empty: FPFH, for which `confidence` was fitted
};

struct AlignResult {
  Pose T_target_source = Pose::Identity();
  double fitness = 0;  ///< share of source points with a target point within 1.5 voxels
  double rmse_m = 0;   ///< over those
  double margin = 0;   ///< log odds by which the best distinct other pose is less likely; 0 when there is none
  double confidence =
      0;  ///< probability that the pose is right: off by less than 0.2 m (RMSE over what overlaps)
  bool trusted = false;  ///< confidence is at least 1 - AlignOptions::risk
  bool found = false;    ///< or no pose came into question, and all the above says nothing
};

/// A pose that is not ruled out, refined.
struct AlignHypothesis {
  Alignment alignment;
  AlignEvidence evidence;
  double log_odds = 0;
};

/// The distinct poses that come into question, likeliest first; may be empty. Errors as `align_clouds`.
[[nodiscard]] Result<std::vector<AlignHypothesis>> align_hypotheses(const Cloud& source, const Cloud& target,
                                                                    const AlignOptions& options);

/// Aligns two bare clouds, each seen from about the origin of its own frame: normals are turned there, and
/// points of one in space that the other saw empty count against a pose. Errors: an option out of range, a
/// cloud with fewer than 50 points after thinning, or one far from its origin. A poor fit is a result.
[[nodiscard]] Result<AlignResult> align_clouds(const Cloud& source, const Cloud& target,
                                               const AlignOptions& options);

}  // namespace liloc
