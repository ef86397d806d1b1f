#include "proto-tests/sim/other_mount.hpp"

#include <algorithm>
#include <cmath>

#include "proto-tests/sim/rig.hpp"

namespace liloc::sim {

using Eigen::Vector2d;

Pose draw_other_mount(Random& random, int index, int count, const Eigen::Vector3d& size) {
  const double around = 2 * (size.x() + size.y()), off = random.uniform(0.1, 0.5);
  double along = around * (index + random.uniform(0.1, 0.9)) / count;  // each has its own stretch of wall
  Vector2d at(off, off);
  if (along < size.x()) {
    at.x() = along;
  } else if ((along -= size.x()) < size.y()) {
    at = {size.x() - off, along};
  } else if ((along -= size.y()) < size.x()) {
    at = {size.x() - along, size.y() - off};
  } else {
    at.y() = size.y() - (along - size.x());
  }
  at = at.cwiseMax(off).cwiseMin(size.head<2>().array().matrix() - Vector2d(off, off));
  const Vector2d aim(size.x() * random.uniform(0.25, 0.75), size.y() * random.uniform(0.25, 0.75));
  const double z = std::min(size.z() - 0.05, random.uniform(2.3, 4.0));
  return looking({at.x(), at.y(), z}, std::atan2(aim.y() - at.y(), aim.x() - at.x()), random.uniform(0.33, 0.8),
                 random.uniform(-0.12, 0.12));  // 19 to 46 degrees down
}

}  // namespace liloc::sim
