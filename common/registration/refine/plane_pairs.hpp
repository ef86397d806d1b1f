#pragma once
#include <vector>

#include "common/registration/points/vectors.hpp"
#include "common/registration/refine/pairs.hpp"

namespace liloc {

/// The normal equations of one iteration, taken about the source's origin so that they stay well conditioned.
struct NormalEquations {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  double squared = 0, weight = 0;  ///< sums of the weighted squared residuals and of the weights
  int pairs = 0;
};

/// The pairs of `for_each_pair`, point to plane, eight at a time. Keeps its memory from pose to pose; one
/// thread. Both sides of `side` have normals and outlive this.
class PlanePairs {
 public:
  explicit PlanePairs(const Side& side);
  /// Sums over the pairs at `T`, to single precision.
  [[nodiscard]] NormalEquations at(const Pose& T, double distance_m, double min_normal_agreement);

 private:
  void find(const Eigen::Vector3f& t, float limit);
  [[nodiscard]] NormalEquations sums() const;

  const Side side_;
  const Vectors source_, source_normals_;
  Vectors arms_, normals_, offsets_, target_normals_;
  std::vector<std::int32_t> partners_;
  std::vector<float> rows_;  ///< the Jacobian and the residual by columns, times the root of each pair's weight
  std::vector<float> roots_;
};

}  // namespace liloc
