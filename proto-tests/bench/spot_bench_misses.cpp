#include "proto-tests/bench/spot_bench_misses.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/registration/spot/polish.hpp"

namespace liloc::bench {
namespace {

bool right(const Pose& T, const Pose& T_true) {
  return degrees(angle_between_rad(T, T_true)) <= 10 && distance_m(T, T_true) <= 0.3;
}

}  // namespace

Miss miss_of(const SpotProblem& problem, const Pose& T_map_sensor, const Pose& T_map_sensor_true) {
  if (right(T_map_sensor, T_map_sensor_true)) return Miss::none;
  Hypothesis at_truth = refine_and_judge(problem, T_map_sensor_true);
  if (!is_clean(at_truth)) at_truth = polish(problem, T_map_sensor_true, std::move(at_truth));
  if (!right(at_truth.T_map_sensor(), T_map_sensor_true)) return Miss::refining;
  const double answered =
      judge(problem.target, problem.query, problem.query.medium, T_map_sensor, problem.judging.fine_tolerance_m)
          .score;
  return at_truth.judgement.score > answered ? Miss::proposing : Miss::judging;
}

void print_misses(const std::vector<Row>& rows) {
  const auto count = [&](Miss miss) {
    return std::ranges::count_if(rows,
                                 [&](const Row& r) { return r.cold && r.overlap >= 0.3 && r.miss == miss; });
  };
  fmt::print("cold misses, overlap over 0.3: {} lost in proposing, {} in refining, {} in judging\n",
             count(Miss::proposing), count(Miss::refining), count(Miss::judging));
}

}  // namespace liloc::bench
