#pragma once
// Where the ceiling LiDARs hang: T_map_sensor of each, from a scan of the room or from their overlap.
#include <cstdint>
#include <string>
#include <vector>

#include "server/survey/joint_refine.hpp"
#include "server/survey/trust.hpp"

namespace liloc::survey {

/// The voxel size of a calibration's clouds: at 0.04 m a view of 9 m depth still has normals.
constexpr double kVoxel_m = 0.04;

struct CalibrationOptions {
  /// LiDARs, by index, whose T_map_sensor is no guess: they are searched for. Without a scan the first LiDAR
  /// stays where it is.
  std::vector<bool> search;
  std::uint64_t seed = 1;
};

struct CalibratedLidar {
  Pose T_map_sensor = Pose::Identity();
  double moved_m = 0, moved_rad = 0;  ///< from the guess
  PoseEvidence evidence;
  DepthError error, error_sd;  ///< of its depth; told, not applied to the pose
  std::string doubt;           ///< empty: trusted
  [[nodiscard]] bool trusted() const { return doubt.empty(); }
};

/// One result per scan, in their order. `reference` null: from the LiDARs' overlap; the first stays. Errors: no
/// scan, `search` of another size, one LiDAR and no reference. A poor fit is a result with a doubt. Pure.
[[nodiscard]] Result<std::vector<CalibratedLidar>> calibrate(const std::vector<LidarScan>& scans,
                                                             const Reference* reference,
                                                             const CalibrationOptions& options);

}  // namespace liloc::survey
