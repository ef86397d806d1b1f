#pragma once
#include <vector>

#include "common/geometry/cloud.hpp"
#include "common/geometry/pose.hpp"

namespace liloc {

/// The free space around the origin of a cloud that was seen from about there, in all directions: up to the
/// nearest point of a direction (and of its neighbours) there is nothing. For bare clouds, of which no camera
/// is known; they may be stitched from views about a metre apart, so edges are given room. Immutable.
class Panorama {
 public:
  /// `points`: one per voxel, in the cloud's own frame.
  explicit Panorama(const std::vector<Eigen::Vector3f>& points);

  /// Whether the cloud can have been seen from its origin: few of its points hide behind others.
  [[nodiscard]] bool seen_from_origin() const { return seen_from_origin_; }
  /// Of some points, how many lie in a measured direction at all, how many of them over `tolerance_m` before
  /// what was measured there, and how many about there: behind by no more than that and two thirds of it.
  struct Count {
    int conflict = 0, agree = 0, known = 0;
  };
  [[nodiscard]] Count count(const std::vector<Eigen::Vector3f>& points, const Pose& T_origin_points,
                            double tolerance_m) const;

 private:
  [[nodiscard]] float nearest_about(int column, int row) const;  ///< 0: not known

  std::vector<float> nearest_m_;  ///< per direction, the neighbours included; 0: not known
  bool seen_from_origin_ = false;
};

}  // namespace liloc
