#include "common/registration/spot/spot.hpp"

#include <algorithm>
#include <functional>

#include "common/registration/spot/polish.hpp"
#include "common/registration/spot/ranking.hpp"
#include "common/registration/target/surface_bits.hpp"

namespace liloc {
namespace {

constexpr int kSketchIterations = 6;  // twelve won on some sites and lost on others, DECISIONS.md

double standing_at(const SpotProblem& problem, const Cloud& device_points, const Pose& T_map_sensor,
                   const Judgement& judgement, const Ranking& ranking) {
  SurfaceBits bits;
  bits.add(problem.target, device_points, T_map_sensor);
  return standing_of(judgement, bits.sum(), ranking);
}

/// Moves each candidate nearer with few points, unless that makes it worse, as it does where surfaces do not
/// hold a pose; and says how it stands.
void sketch(const SpotProblem& problem, std::vector<Candidate>* candidates) {
  const JudgeOptions& options = problem.judging;
  const auto judged = [&](const Pose& T_map_sensor) {
    return judge(problem.target, problem.query, problem.query.sparse, T_map_sensor, options.sketch_tolerance_m,
                 MapShare::half, options.sketch_conflict_weight);
  };
  for (Candidate& c : *candidates) {
    const Pose nearer =
        approach(problem.target, problem.query, c.T_map_sensor, kSketchIterations, options.refine);
    Judgement best = judged(c.T_map_sensor);
    const Judgement there = judged(nearer);
    if (there.score >= best.score) {
      best = there;
      c.T_map_sensor = nearer;
    }
    c.score = standing_at(problem, problem.query.sparse, c.T_map_sensor, best, kSketchRanking);
  }
}

/// Free space polishes what surfaces do not hold, unless something else explains all by far better.
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
      refined[i] = polish(problem, candidates[i].T_map_sensor, std::move(refined[i]));
  return refined;
}

}  // namespace

std::vector<Hypothesis> judge_candidates(const SpotProblem& problem, std::vector<Candidate> candidates) {
  const JudgeOptions& options = problem.judging;
  candidates = distinct(std::move(candidates), options.sketch_most);
  sketch(problem, &candidates);
  candidates = distinct(std::move(candidates), options.refine_most);
  std::vector<Hypothesis> refined = refined_of(problem, candidates);
  for (Hypothesis& h : refined)
    h.standing = standing_at(problem, problem.query.medium, h.T_map_sensor(), h.judgement, kRefinedRanking);
  // Its rivals are those that the judge likes best, as when the confidence was fitted.
  std::ranges::stable_sort(refined, std::ranges::greater(),
                           [](const Hypothesis& h) { return h.judgement.score; });
  const auto best = std::ranges::max_element(refined, {}, &Hypothesis::standing);
  if (best != refined.end()) std::rotate(refined.begin(), best, best + 1);
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
