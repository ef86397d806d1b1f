#pragma once
// Whether a LiDAR's calibration may be used, and why not.
#include <string>

#include "common/registration/target/target.hpp"
#include "server/survey/lidar_scan.hpp"

namespace liloc::survey {

/// What speaks for and against a LiDAR's pose.
struct PoseEvidence {
  double overlap = 0;           ///< share of its points with one of the rest of the room within 0.05 m
  double residual_m = 0;        ///< RMSE along the normals, of its pairs (JointLidar)
  double conflict = 0;          ///< share of what it should see of the rest that lies in space it saw empty
  int seen = 0;                 ///< points of the rest that it should see
  double sd_m = 0, sd_rad = 0;  ///< largest over the directions; `evidence_of`: by residuals alone
};

/// All but `residual_m`. `rest`: everything else that is known of the room, with normals towards whoever saw
/// it.
[[nodiscard]] PoseEvidence evidence_of(const Target& rest, const LidarScan& scan, const Pose& T_map_sensor);

struct TrustOptions {
  double least_overlap = 0.35;    ///< half of the view may have changed since the scan
  double most_conflict = 0.20;    ///< a wrong place contradicts more, by far
  double most_residual_m = 0.03;  ///< pairs are at most 0.06 m apart: 0.035 is that of chance
  double most_sd_m = 0.01, most_sd_rad = radians(0.3);  ///< what a calibration is to reach
};

/// Empty: trusted. Else what is wrong, with the remedy.
[[nodiscard]] std::string doubt_of(const PoseEvidence& evidence, const TrustOptions& options);

}  // namespace liloc::survey
