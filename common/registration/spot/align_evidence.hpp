#pragma once
// How sure one may be of a pose between two bare clouds: what is counted, and the odds that follow.
#include <array>
#include <vector>

#include "common/registration/search/feature_samples.hpp"
#include "common/registration/sight/panorama.hpp"
#include "common/registration/spot/spot.hpp"

namespace liloc {

/// What speaks for and against a pose.
struct AlignEvidence {
  int pairs = 0;       ///< thinned source points with one of the target that faces the same way
  int matched = 0;     ///< features whose likeliest partner lies where the pose puts it
  int conflict = 0;    ///< points of one cloud in space that the other saw empty
  int agree = 0;       ///< points of one cloud where the other saw a surface in their direction
  double fitness = 0;  ///< share of source points with a target point within 1.5 voxels
  double rmse_m = 0;   ///< over those
};

/// What log odds are linear in.
using AlignRegressors = std::array<double, 3>;
[[nodiscard]] AlignRegressors align_regressors(const AlignEvidence& evidence);

/// Log odds that the pose is right, from its own evidence; to rank the poses of one pair of clouds.
[[nodiscard]] double log_odds_of(const AlignEvidence& evidence);

/// Probability that the first of some poses is right: its own, times its share among its rivals, so that of two
/// that are as likely neither is over a half. `log_odds`: of distinct places, best first, not empty.
[[nodiscard]] double confidence_of(const std::vector<double>& log_odds);

/// What both clouds of a problem have to say on any pose. Refers to what it is made of.
class AlignWitness {
 public:
  AlignWitness(const SpotProblem& problem, const std::vector<FeatureMatch>& matches, double voxel_size_m);

  /// Of a refined pose.
  [[nodiscard]] AlignEvidence of(const Alignment& alignment) const;
  /// One number for a pose that is not refined yet, by fewer points; higher is better.
  [[nodiscard]] double sketch_score(const Pose& T_target_source) const;
  /// Whether even a pose that is still off can be right: not too much of it lies in empty space.
  [[nodiscard]] bool possible(const Pose& T_target_source) const;

 private:
  [[nodiscard]] Panorama::Count few_in_space(const Pose& T_target_source, double tolerance_m) const;
  [[nodiscard]] int matched(const Pose& T_target_source) const;

  const SpotProblem& problem_;
  const std::vector<FeatureMatch>& matches_;
  const double voxel_m_;
  const Panorama source_, target_;
  std::vector<Eigen::Vector3f> few_of_target_;
};

}  // namespace liloc
