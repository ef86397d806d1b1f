#include "common/registration/spot.hpp"

#include <algorithm>
#include <cmath>

#include "common/registration/settle.hpp"
#include "common/registration/up.hpp"

namespace liloc {
namespace {

constexpr double kContradicts_rad = radians(5.0);  // planes tell up to a degree or two
constexpr double kSure = 0.5;                      // confidence above which planes may contradict the device
constexpr int kSketchIterations = 6;

}  // namespace

JudgeOptions judge_options_for(double voxel_size_m) {
  JudgeOptions options;
  const double scale = voxel_size_m / 0.05;
  options.fine_tolerance_m *= scale;
  options.sketch_tolerance_m = std::max(options.sketch_tolerance_m, 1.7 * options.fine_tolerance_m);
  options.refine.end_distance_m *= scale;
  options.refine.fit_distance_m *= scale;
  return options;
}

std::vector<UpPair> ups_to_try(const SpotProblem& problem) {
  const std::vector<UpHypothesis> planes = find_up(problem.query.medium);
  std::vector<UpPair> ups;
  if (problem.up_sensor) {
    const bool sure = !planes.empty() && planes.front().confidence > kSure;
    const bool agree = sure && planes.front().up.dot(*problem.up_sensor) >= std::cos(kContradicts_rad);
    ups.push_back({*problem.up_sensor, problem.up_map, agree});
    if (sure && !agree) ups.push_back({planes.front().up, problem.up_map});
    return ups;
  }
  if (!planes.empty()) ups.push_back({planes.front().up, problem.up_map});
  return ups;
}

std::vector<Candidate> GravityProposer::propose(const SpotProblem& problem) const {
  if (!up_ && !problem.up_sensor) return {};
  const UpPair up = up_ ? *up_ : UpPair{*problem.up_sensor, problem.up_map};
  GravitySearchOptions options;
  options.threads = problem.threads;
  options.up_map = up.map;
  options.time_limit = problem.search_limit;
  return gravity_search(problem.target, problem.query, up.sensor, options);
}

std::vector<Candidate> FeatureProposer::propose(const SpotProblem& problem) const {
  FeatureSearchOptions options = options_;
  options.threads = problem.threads;
  options.seed = problem.seed;
  return feature_search(problem.target, problem.target_described(), problem.query, problem.query_described(),
                        options);
}

Hypothesis refine_and_judge(const SpotProblem& problem, const Pose& T_map_sensor_guess,
                            const PosePrior* prior) {
  const JudgeOptions& options = problem.judging;
  Hypothesis h;
  h.alignment = refine(problem.target, problem.query, T_map_sensor_guess, options.refine, prior);
  h.judgement =
      judge(problem.target, problem.query, problem.query.medium, h.T_map_sensor(), options.fine_tolerance_m);
  return h;
}

namespace {

/// Moves each candidate nearer with few points, unless that makes it worse, as it does where surfaces do not
/// hold a pose; and scores it.
void sketch(const SpotProblem& problem, std::vector<Candidate>* candidates) {
  const JudgeOptions& options = problem.judging;
  const auto score = [&](const Pose& T_map_sensor) {
    return judge(problem.target, problem.query, problem.query.sparse, T_map_sensor, options.sketch_tolerance_m,
                 MapShare::half, options.sketch_conflict_weight)
        .score;
  };
  for (Candidate& c : *candidates) {
    const Pose nearer =
        approach(problem.target, problem.query, c.T_map_sensor, kSketchIterations, options.refine);
    c.score = score(c.T_map_sensor);
    const double score_nearer = score(nearer);
    if (score_nearer < c.score) continue;
    c.score = score_nearer;
    c.T_map_sensor = nearer;
  }
}

/// Lines of sight settle what surfaces do not, unless something else explains all by far better.
std::vector<Hypothesis> refined_of(const SpotProblem& problem, const std::vector<Candidate>& candidates) {
  std::vector<Hypothesis> refined;
  bool clean = false;
  for (const Candidate& c : candidates) {
    refined.push_back(refine_and_judge(problem, c.T_map_sensor));
    clean = clean || is_clean(refined.back());
  }
  if (problem.target.views.empty()) return refined;
  for (std::size_t i = 0; i < refined.size(); ++i)
    if (!is_clean(refined[i]) && (!clean || candidates[i].score > candidates[0].score - problem.judging.rival))
      refined[i] = settle(problem, candidates[i].T_map_sensor, std::move(refined[i]));
  return refined;
}

}  // namespace

std::vector<Hypothesis> judge_candidates(const SpotProblem& problem, std::vector<Candidate> candidates) {
  const JudgeOptions& options = problem.judging;
  candidates = distinct(std::move(candidates), options.sketch_most);
  sketch(problem, &candidates);
  candidates = distinct(std::move(candidates), options.refine_most);
  std::vector<Hypothesis> refined = refined_of(problem, candidates);
  std::stable_sort(refined.begin(), refined.end(), [](const Hypothesis& a, const Hypothesis& b) {
    return a.judgement.score > b.judgement.score;
  });
  std::vector<Hypothesis> kept;
  for (const Hypothesis& h : refined) {
    const bool known = std::any_of(kept.begin(), kept.end(), [&](const Hypothesis& k) {
      return same_place(k.T_map_sensor(), h.T_map_sensor());
    });
    if (!known && kept.size() < options.keep) kept.push_back(h);
  }
  return kept;
}

}  // namespace liloc
