#pragma once
#include <cstdint>

#include "common/geometry/cloud.hpp"

namespace liloc {

struct AlignOptions {
  double voxel_size_m = 0.05;  ///< 0.005..1
  bool gravity = false;        ///< both clouds have z up: only x, y, z and yaw are searched
  std::uint64_t seed = 1;
  int threads = 1;
};

struct AlignResult {
  Pose T_target_source = Pose::Identity();
  double fitness = 0;  ///< share of source points with a target point within 1.5 voxels
  double rmse_m = 0;   ///< over those
  double margin = 0;   ///< share by which the fit beats that of the best distinct other pose, 0..1
  bool trusted = false;
};

/// Aligns two bare clouds, each seen from about the origin of its own frame: normals are turned there, and
/// points of one in space that the other saw empty count against a pose. Errors: an option out of range, a
/// cloud with fewer than 50 points after thinning, or one far from its origin. A poor fit is a result.
[[nodiscard]] Result<AlignResult> align_clouds(const Cloud& source, const Cloud& target,
                                               const AlignOptions& options);

}  // namespace liloc
