#pragma once
// All LiDARs refined together: against the scan and against each other.
#include <vector>

#include "server/survey/lidar_scan.hpp"
#include "server/survey/reference.hpp"

namespace liloc::survey {

struct JointOptions {
  double start_distance_m = 0.15;  ///< farther pairs are ignored at first ...
  double end_distance_m = 0.06;    ///< ... and at last: furniture that was moved since the scan does not pull
  int iterations = 25;
  double min_normal_agreement = 0.7;         ///< cosine between the two normals of a pair
  bool depth_errors = false;                 ///< scale and bias of each sensor are estimated as well
  double scale_sd = 0.02, bias_sd_m = 0.01;  ///< what depth sensors are known for, beforehand
  double voxel_size_m = 0.04;                ///< of the clouds
};

struct JointLidar {
  const Cloud* cloud = nullptr;  ///< LidarScan::cloud; outlives the call
  Pose T_map_sensor = Pose::Identity();
  bool fixed = false;     ///< it holds the others where it is
  bool left_out = false;  ///< it stays where it is, and holds nobody
  // Where JointOptions::depth_errors:
  DepthError error, error_sd;
  /// Of the pose, [rotation about the sensor; shift] in the map's axes, whatever scale and bias of all LiDARs
  /// may be: pixels of one sensor err together, of which residuals know nothing.
  Matrix6d covariance = Matrix6d::Zero();
  double residual_m = 0;  ///< RMSE along the normals, over its pairs
  int pairs = 0;          ///< of the last iteration, with the scan and with others
};

/// Gauss-Newton over all poses at once, point to plane. `reference` null: LiDARs alone, of which one is fixed.
/// Pure.
void refine_together(const Reference* reference, std::vector<JointLidar>* lidars, const JointOptions& options);

}  // namespace liloc::survey
