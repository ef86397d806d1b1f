#pragma once
#include "common/geometry/cloud.hpp"

namespace liloc {

/// Defaults are by hand where nothing else is said.
struct NormalOptions {
  double radius_m = 0.125;  ///< 2.5 voxels of 0.05 m: about 20 neighbours on a surface
  int min_neighbors = 5;    ///< fewer (the point itself counts) hang in the air: the point is dropped
  /// A cloud of which fewer than a third of the points have so many is sparse: the radius grows by halves, up
  /// to this. 0: it stays.
  double widest_m = 0;
};

/// The points that have enough neighbours, each with the direction in which its neighbourhood is thinnest
/// (PCA), turned towards `sensor_position` (the frame of the cloud): a normal that is known to face the sensor
/// lifts the share of right feature matches by half.
[[nodiscard]] Cloud with_normals(const Cloud& cloud, const Eigen::Vector3f& sensor_position,
                                 const NormalOptions& options = {});

}  // namespace liloc
