#pragma once
// The shell of a site: floor, ceiling, four walls with recessed doors and windows, lamps and radiators.
#include "proto-tests/sim/base/random.hpp"
#include "proto-tests/sim/shapes/mesh.hpp"

namespace liloc::sim {

struct RoomStyle {
  bool symmetric = false;             ///< the same after half a turn
  Material floor = Material::carpet;  ///< matte or carpet
  bool niches = false;  ///< half-open walls: wide openings into deep recesses, some above a parapet
};

/// The inside, from (0, 0, 0) to `size_m`; z is up.
[[nodiscard]] Mesh make_room(Random& random, const Eigen::Vector3d& size_m, const RoomStyle& style);

}  // namespace liloc::sim
