#include "common/registration/spot/hypothesis.hpp"

#include <algorithm>

namespace liloc {

JudgeOptions judge_options_for(double voxel_size_m) {
  JudgeOptions options;
  const double scale = voxel_size_m / 0.05;
  options.fine_tolerance_m *= scale;
  options.sketch_tolerance_m = std::max(options.sketch_tolerance_m, 1.7 * options.fine_tolerance_m);
  options.refine.end_distance_m *= scale;
  options.refine.fit_distance_m *= scale;
  return options;
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

}  // namespace liloc
