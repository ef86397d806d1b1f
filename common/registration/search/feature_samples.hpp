#pragma once
#include <cstdint>
#include <vector>

#include "common/registration/field/score_fields.hpp"
#include "common/registration/search/candidate.hpp"

namespace liloc {

/// A described point of the query and the one of the target that is most like it, each with its normal.
struct FeatureMatch {
  Eigen::Vector3f source, target, source_normal, target_normal;
};

/// Of what a pose is made.
enum class Sample {
  three_points,  ///< as in the paper
  two_normals,   ///< two points and their normals: one right match fewer is needed
};

/// Defaults are by hand where nothing else is said.
struct SampleOptions {
  Sample sample = Sample::three_points;
  int iterations = 60000;
  std::size_t keep = 24;     ///< samples; many are of one place
  bool free_space = true;    ///< samples lose by points in empty space
  double edge_ratio = 0.85;  ///< three points: the sides of both triangles agree to this share
  double spacing_m = 0.1;    ///< two normals: of the described points
  std::uint64_t seed = 1;
};

/// RANSAC: poses of random samples of the matches, scored by `points` on the target's field with an early stop,
/// and for two normals by how many matches agree too. The best `keep`, in no order. Pure.
[[nodiscard]] std::vector<Candidate> sample_poses(const ScoreFields& field,
                                                  const std::vector<Eigen::Vector3f>& points,
                                                  const std::vector<FeatureMatch>& matches,
                                                  const SampleOptions& options);

}  // namespace liloc
