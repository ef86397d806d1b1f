#pragma once
// Where a right answer was lost.
#include <string>
#include <vector>

#include "common/registration/spot/hypothesis.hpp"
#include "proto-tests/bench/spot_bench_row.hpp"

namespace liloc::bench {

/// Of a search's answer that is off by more than 10 degrees or 0.3 m: proposed, the truth would have won; or
/// refinement leaves it; or the answer stands higher.
[[nodiscard]] Miss miss_of(const SpotProblem& problem, const Pose& T_map_sensor, const Pose& T_map_sensor_true);

/// What the cold misses at an overlap over 0.3 are made of.
void print_misses(const std::vector<Row>& rows);

}  // namespace liloc::bench
