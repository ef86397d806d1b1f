#pragma once
// What one spot asks, and one pose as an answer to it: refined and judged.
#include <chrono>
#include <cstdint>
#include <functional>
#include <optional>

#include "common/registration/refine/refine.hpp"
#include "common/registration/search/feature_search.hpp"
#include "common/registration/search/gravity_search.hpp"
#include "common/registration/spot/judge.hpp"

namespace liloc {

/// How candidates are weighed; the defaults are for voxels of 0.05 m.
/// Defaults are by hand where nothing else is said.
struct JudgeOptions {
  double sketch_tolerance_m = 0.085, fine_tolerance_m = 0.05;
  double sketch_conflict_weight = 8;  ///< before a pose is refined it may still conflict a little
  /// Of the candidates, how many are refined with few points; as many as a search proposes.
  std::size_t sketch_most = 60;
  std::size_t refine_most = 8;  ///< of those, how many are refined fully
  double rival = 3;             ///< in points of standing: so near the best, a candidate is worth any effort
  std::size_t keep = 5;
  RefineOptions refine;
};
/// What has to follow the voxel size does: tolerances and the distances of pairs.
[[nodiscard]] JudgeOptions judge_options_for(double voxel_size_m);

/// All that a proposer may look at. `target_described` and `query_described` are made when first asked for.
struct SpotProblem {
  const Target& target;
  const Query& query;
  std::optional<Eigen::Vector3d> up_sensor = std::nullopt;  ///< against gravity, as the device says
  Eigen::Vector3d up_map = Eigen::Vector3d::UnitZ();
  std::function<const Described&()> target_described = {}, query_described = {};
  std::uint64_t seed = 1;
  int threads = 1;
  JudgeOptions judging = {};
  std::chrono::steady_clock::duration search_limit = GravitySearchOptions{}.time_limit;
};

/// A refined and judged pose.
struct Hypothesis {
  Alignment alignment;
  Judgement judgement;
  double standing = 0;  ///< among what its search found (`standing_of`); 0 of a pose that was not searched for
  [[nodiscard]] const Pose& T_map_sensor() const { return alignment.T_target_source; }
};

/// Refines and judges a single pose, e.g. a predicted one.
[[nodiscard]] Hypothesis refine_and_judge(const SpotProblem& problem, const Pose& T_map_sensor_guess,
                                          const PosePrior* prior = nullptr);

}  // namespace liloc
