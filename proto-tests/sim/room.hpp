#pragma once
// The shell of a site: floor, ceiling, four walls with recessed doors and windows, lamps and radiators.
#include "proto-tests/sim/mesh.hpp"
#include "proto-tests/sim/random.hpp"

namespace liloc::sim {

/// The inside, from (0, 0, 0) to `size_m`; z is up.
[[nodiscard]] Mesh make_room(Random& random, const Eigen::Vector3d& size_m, bool symmetric);

}  // namespace liloc::sim
