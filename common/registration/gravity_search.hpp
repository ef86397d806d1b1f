#pragma once
#include <chrono>
#include <vector>

#include "common/registration/candidate.hpp"
#include "common/registration/target.hpp"

namespace liloc {

struct GravitySearchOptions {
  double yaw_step_deg = 5.0;
  std::size_t keep = 250;    ///< coarse maxima that are climbed on the fine field
  std::size_t propose = 40;  ///< distinct poses returned, best first
  std::chrono::steady_clock::duration time_limit = std::chrono::seconds(2);
  int threads = 1;
  Eigen::Vector3d up_map = Eigen::Vector3d::UnitZ();  ///< unit; other than z where the map is not level
};

/// With gravity known four unknowns remain: every x, y, z and yaw at 0.2 m and `yaw_step_deg` is scored on the
/// target's coarse field by adding whole rows of it, with a third of the points at first; the best are scored
/// with all and climbed on the fine field. `up_sensor`: unit vector against gravity in sensor axes. Past the
/// time limit the yaws searched so far count. Needs the target's fields.
[[nodiscard]] std::vector<Candidate> gravity_search(const Target& target, const Query& query,
                                                    const Eigen::Vector3d& up_sensor,
                                                    const GravitySearchOptions& options = {});

}  // namespace liloc
