#pragma once
// A scan of the room that the ceiling LiDARs are registered to.
#include "common/geometry/cloud.hpp"
#include "common/geometry/pose.hpp"
#include "common/registration/points/nearest_grid.hpp"

namespace liloc::survey {

/// Thinned points of a scan with the directions of their surfaces, and an index over them. A bare scan does not
/// tell on which side of a surface the air is: whoever looks at it does. Immutable; any thread may read it.
class Reference {
 public:
  /// `scan_map`: points in metres. Errors: fewer than 500 points on surfaces, a room of under 0.5 m or over 500
  /// m (probably not in metres).
  [[nodiscard]] static Result<Reference> create(const Cloud& scan_map, double voxel_size_m);

  /// All points, each with its normal towards `position_map`.
  [[nodiscard]] Cloud facing(const Eigen::Vector3f& position_map) const;
  /// Indices are those of `facing`.
  [[nodiscard]] const NearestGrid& nearest() const { return nearest_; }
  [[nodiscard]] const Cloud& cloud_map() const { return cloud_; }
  /// The middle of the points by their medians.
  [[nodiscard]] Eigen::Vector3f middle_map() const;

 private:
  explicit Reference(Cloud cloud_map, double voxel_size_m);
  Cloud cloud_;
  NearestGrid nearest_;
};

}  // namespace liloc::survey
