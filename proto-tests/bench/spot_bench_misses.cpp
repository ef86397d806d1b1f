#include "proto-tests/bench/spot_bench_misses.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/registration/spot/spot.hpp"

namespace liloc::bench {
namespace {

bool right(const Pose& T, const Pose& T_true) {
  return degrees(angle_between_rad(T, T_true)) <= 10 && distance_m(T, T_true) <= 0.3;
}

}  // namespace

Miss miss_of(const SpotProblem& problem, const Pose& T_map_sensor, const Pose& T_map_sensor_true) {
  if (right(T_map_sensor, T_map_sensor_true)) return Miss::none;
  const auto proposed = [&](const Pose& T) { return judge_candidates(problem, {{T, 0}}).front(); };
  const Hypothesis at_truth = proposed(T_map_sensor_true);
  if (!right(at_truth.T_map_sensor(), T_map_sensor_true)) return Miss::refining;
  return at_truth.standing > proposed(T_map_sensor).standing ? Miss::proposing : Miss::judging;
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
