#pragma once
#include <Eigen/Core>
#include <vector>

#include "common/geometry/cloud.hpp"

namespace liloc {

/// A patch of surface: the points of one voxel, summed up. The mean of dozens of noisy points lies on the
/// surface to a millimetre, which a single point does not.
struct Surfel {
  Eigen::Vector3f mean = Eigen::Vector3f::Zero();        ///< metres
  Eigen::Matrix3f covariance = Eigen::Matrix3f::Zero();  ///< of the points about the mean, m^2
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();      ///< unit, towards the sensor
  float flatness = 0;                                    ///< 0 (a ball) .. 1 (a plane)
  float count = 0;                                       ///< points
};

/// Defaults are by hand where nothing else is said.
struct SurfelOptions {
  double size_m = 0.10;  ///< voxel edge; two LPC voxels hold enough points for a normal up to 6 m away
  int min_points = 6;    ///< fewer have no direction
};

/// One surfel per voxel with enough points, normals turned towards `sensor_position` (frame of the cloud).
[[nodiscard]] std::vector<Surfel> extract_surfels(const Cloud& cloud, const Eigen::Vector3f& sensor_position,
                                                  const SurfelOptions& options = {});

/// Sets normal and flatness from the covariance; the normal faces `towards` (a point in the surfel's frame).
void orient(Surfel& surfel, const Eigen::Vector3f& towards);

}  // namespace liloc
