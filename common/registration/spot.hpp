#pragma once
// One spot: propose by whatever is known, judge all candidates alike, refine the best few.
#include <chrono>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "common/registration/feature_search.hpp"
#include "common/registration/gravity_search.hpp"
#include "common/registration/judge.hpp"
#include "common/registration/refine.hpp"

namespace liloc {

/// How candidates are weighed; the defaults are for voxels of 0.05 m.
struct JudgeOptions {
  double sketch_tolerance_m = 0.085, fine_tolerance_m = 0.05;
  double sketch_conflict_weight = 8;  ///< before a pose is refined it may still conflict a little
  std::size_t sketch_most = 60;       ///< of the candidates, how many are refined with few points
  std::size_t refine_most = 8;        ///< of those, how many are refined fully
  double rival = 0.3;                 ///< in points of score: so near the best, a candidate is worth any effort
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

/// A way to find candidate poses. Stateless; any thread may call it.
class Proposer {
 public:
  virtual ~Proposer() = default;
  [[nodiscard]] virtual std::string_view name() const = 0;
  /// Empty when the proposer cannot work on this problem (no gravity, no features).
  [[nodiscard]] virtual std::vector<Candidate> propose(const SpotProblem& problem) const = 0;
};

/// A direction of the device's frame and one of the map's that are taken for the same: up.
struct UpPair {
  Eigen::Vector3d sensor, map;
  bool borne_out = false;  ///< the device's gravity and the planes it sees agree
};
/// What to search with, likeliest first: gravity as the device says, and where the planes it sees contradict,
/// as they say. Of a device that says nothing, the likeliest that its planes say, alone: features find sooner
/// what that misses.
[[nodiscard]] std::vector<UpPair> ups_to_try(const SpotProblem& problem);

class GravityProposer final : public Proposer {
 public:
  /// Without `up` it takes the device's word.
  explicit GravityProposer(std::optional<UpPair> up = std::nullopt) : up_(std::move(up)) {}
  [[nodiscard]] std::string_view name() const override { return "gravity"; }
  [[nodiscard]] std::vector<Candidate> propose(const SpotProblem& problem) const override;

 private:
  std::optional<UpPair> up_;
};

class FeatureProposer final : public Proposer {
 public:
  explicit FeatureProposer(FeatureSearchOptions options) : options_(options) {}
  [[nodiscard]] std::string_view name() const override { return "features"; }
  [[nodiscard]] std::vector<Candidate> propose(const SpotProblem& problem) const override;

 private:
  FeatureSearchOptions options_;
};

/// A refined and judged pose.
struct Hypothesis {
  Alignment alignment;
  Judgement judgement;
  [[nodiscard]] const Pose& T_map_sensor() const { return alignment.T_target_source; }
};

/// Judges candidates roughly, refines the best, judges them again: distinct hypotheses, best first.
[[nodiscard]] std::vector<Hypothesis> judge_candidates(const SpotProblem& problem,
                                                       std::vector<Candidate> candidates);

/// Refines and judges a single pose, e.g. a predicted one.
[[nodiscard]] Hypothesis refine_and_judge(const SpotProblem& problem, const Pose& T_map_sensor_guess,
                                          const PosePrior* prior = nullptr);

}  // namespace liloc
