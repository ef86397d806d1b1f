#pragma once
// LiDAR mounts of world 2, as another simulator would draw them.
#include "common/geometry/pose.hpp"
#include "proto-tests/sim/base/random.hpp"

namespace liloc::sim {

/// Where a LiDAR of world 2 hangs: anywhere along the walls, at 2.3 to 4 m, tilted as it came.
[[nodiscard]] Pose draw_other_mount(Random& random, int index, int count, const Eigen::Vector3d& size_m);

}  // namespace liloc::sim
