#pragma once
#include "common/registration/target/target.hpp"

namespace liloc {

/// Defaults are by hand where nothing else is said.
struct RefineOptions {
  double start_distance_m = 0.20;  ///< farther pairs are ignored at first ...
  double end_distance_m = 0.08;    ///< ... and at last
  int sparse_iterations = 10;      ///< few device points against the thinned target: far from the answer
  int coarse_iterations = 6;       ///< thinned clouds, at distances down to twice the end
  int fine_iterations = 8;         ///< thinned device cloud against the full target
  /// Cosine between the two normals of a pair; 0.8 was level (DECISIONS.md).
  double min_normal_agreement = 0.5;
  double fit_distance_m = 0.05;  ///< a point with one of the target's so near counts for the fitness
  /// How tightly each of the three passes is held to where it starts: as by so large a share of all pairs, were
  /// they to hold that direction. Noisy normals on a bare floor walk further than its few real edges pull.
  double hold = 0;
  bool point_to_point = false;  ///< the paper's ICP, for comparison
};

/// How well a pose fits. Where the pose itself is poor this is a graded result, not an error.
struct Alignment {
  Pose T_target_source = Pose::Identity();
  double fitness = 0;        ///< share of source points with a target point within one voxel
  double inlier_rmse_m = 0;  ///< distance along the normal, over those
  int pairs = 0;
  double pair_share = 0;  ///< of the thinned source points that are not beside somebody
  bool converged = false;
};

/// What is known of the pose beforehand, e.g. from odometry; it holds the directions that no surface observes.
struct PosePrior {
  Pose T_target_source = Pose::Identity();
  double sd_rad = 0.02, sd_m = 0.05;
  double residual_sd_m = 0.02;  ///< of one pair, by which surfaces and prior are weighed against each other
};

/// Refines a guess by iterated closest points: point-to-plane along the mean of both normals, pairs weighted by
/// Geman-McClure with a width that shrinks from start to end distance. Pure; many threads may share `target`.
[[nodiscard]] Alignment refine(const Target& target, const Query& query, const Pose& T_target_source_guess,
                               const RefineOptions& options = {}, const PosePrior* prior = nullptr);

/// Its first iterations alone, by few points and without evidence: to rank many guesses.
[[nodiscard]] Pose approach(const Target& target, const Query& query, const Pose& T_target_source_guess,
                            int iterations, const RefineOptions& options = {});

/// Share of points with a target point within `distance_m` and the RMSE over them, without refinement.
struct Fit {
  double fitness = 0, inlier_rmse_m = 0;
};
[[nodiscard]] Fit fit_of(const Target& target, const Cloud& cloud_source, const Pose& T_target_source,
                         double distance_m);

}  // namespace liloc
