#pragma once
// The pairs of iterated closest points: what a point of the source is matched with, and how much that counts.
#include "common/registration/target/target.hpp"

namespace liloc {

/// Width of the Geman-McClure kernel, of the squared limit: a pair at half the distance weighs a quarter.
constexpr float kKernelShare = 0.25F;

/// Two clouds to be matched, with the index of the one that stands still.
struct Side {
  const Cloud& target;
  const NearestGrid& nearest;
  const Cloud& source;
  const VoxelMask* dynamic_mask = nullptr;  ///< where somebody moves nothing is paired

  /// The index of a source point's partner, or NearestGrid::kNone.
  [[nodiscard]] std::int32_t partner_of(const Eigen::Vector3f& p_target) const {
    const std::int32_t j = nearest.nearest(p_target);
    return j != NearestGrid::kNone && dynamic_mask != nullptr && dynamic_mask->at(p_target) ? NearestGrid::kNone
                                                                                            : j;
  }
};

/// A target, thinned and whole, and a cloud of the query.
[[nodiscard]] inline Side coarse_side(const Target& target, const Cloud& source) {
  return {target->coarse, target->nearest_coarse, source, target.dynamic_mask()};
}
[[nodiscard]] inline Side fine_side(const Target& target, const Cloud& source) {
  return {target->cloud, target->nearest, source, target.dynamic_mask()};
}

/// Calls visit(source index, arm, normal of the pair, offset, weight) for each pair; the normal is zero where a
/// side has none. `arm` and all else in the target's axes.
template <class Visit>
void for_each_pair(const Side& side, const Pose& T, double distance_m, double min_normal_agreement,
                   const Visit& visit) {
  const Eigen::Isometry3f Tf = T.cast<float>();
  const bool with_normals = side.source.has_normals() && side.target.has_normals();
  const auto agreement = static_cast<float>(min_normal_agreement);
  const auto limit = static_cast<float>(distance_m * distance_m);
  const double width = kKernelShare * limit;
  for (std::size_t i = 0; i < side.source.size(); ++i) {
    const Eigen::Vector3f arm = Tf.linear() * side.source.points[i];
    const Eigen::Vector3f p = arm + Tf.translation();
    const std::int32_t j = side.partner_of(p);
    if (j == NearestGrid::kNone) continue;
    const Eigen::Vector3f offset = p - side.target.points[static_cast<std::size_t>(j)];
    const float squared = offset.squaredNorm();
    if (squared > limit) continue;
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    if (with_normals) {
      const Eigen::Vector3f& n_target = side.target.normals[static_cast<std::size_t>(j)];
      const Eigen::Vector3f n_source = Tf.linear() * side.source.normals[i];
      if (n_target.dot(n_source) < agreement) continue;
      normal = (n_target + n_source).normalized();
    }
    const double root = width / (width + static_cast<double>(squared));
    visit(i, arm, normal, offset, root * root);
  }
}

/// Of the distance along `normal`, by a turn about the source's origin and a shift, in the target's axes.
[[nodiscard]] inline Vector6d jacobian_of(const Eigen::Vector3f& arm, const Eigen::Vector3f& normal) {
  Vector6d jacobian;
  jacobian << arm.cross(normal).cast<double>(), normal.cast<double>();
  return jacobian;
}

}  // namespace liloc
