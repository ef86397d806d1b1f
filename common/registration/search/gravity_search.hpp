#pragma once
#include <chrono>
#include <vector>

#include "common/registration/search/candidate.hpp"
#include "common/registration/target/target.hpp"

namespace liloc {

/// Defaults are by hand where nothing else is said.
struct GravitySearchOptions {
  double yaw_step_deg = 5.0;
  std::size_t climb_first = 800;   ///< best places of the coarse pass, climbed a little
  std::size_t climb_second = 200;  ///< of those, climbed to the top
  std::size_t propose = 60;        ///< distinct poses returned, best first
  std::chrono::steady_clock::duration time_limit =
      std::chrono::hours(1);  ///< none, or answers would depend on load
  int threads = 1;
  Eigen::Vector3d up_map = Eigen::Vector3d::UnitZ();  ///< unit; other than z where the map is not level
};

/// With gravity known four unknowns remain: every x, y, z and yaw at 0.2 m and `yaw_step_deg` is scored on the
/// target's coarse field by adding whole rows of it; the best places are climbed on the fine field. People that
/// the ceiling sees count neither way. `up_sensor`: unit vector against gravity in sensor axes. Past the time
/// limit the yaws searched so far count. Needs the target's fields.
[[nodiscard]] std::vector<Candidate> gravity_search(const Target& target, const Query& query,
                                                    const Eigen::Vector3d& up_sensor,
                                                    const GravitySearchOptions& options = {});

}  // namespace liloc
