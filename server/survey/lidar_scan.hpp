#pragma once
// What stands still before one ceiling LiDAR, as it measured it.
#include "common/geometry/camera.hpp"
#include "common/geometry/cloud.hpp"

namespace liloc::survey {

/// How a sensor's depth errs: true depth = depth * (1 + scale) + bias_m.
struct DepthError {
  double scale = 0, bias_m = 0;
};

struct LidarScan {
  GlobalLidar lidar;    ///< its T_map_sensor is the first guess
  DepthImage surfaces;  ///< the mean of many frames without what moves (Background::surfaces)
  Cloud cloud;          ///< of it: sensor frame, one point per voxel, normals towards the sensor
};

/// Errors: the image is not of the camera's size, under 500 points on surfaces; each names the LiDAR.
[[nodiscard]] Result<LidarScan> make_scan(GlobalLidar lidar, DepthImage surfaces, double voxel_size_m);

/// The cloud with its depths put right.
[[nodiscard]] Cloud corrected(const Cloud& cloud_sensor, const DepthError& error);

}  // namespace liloc::survey
