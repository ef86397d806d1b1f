#pragma once
// Pieces of furniture with random measures. Each stands on z = 0, centred, its back towards +y.
#include "proto-tests/sim/base/random.hpp"
#include "proto-tests/sim/shapes/mesh.hpp"

namespace liloc::sim {

struct Furniture {
  Mesh mesh;
  Eigen::Vector2d half_size = Eigen::Vector2d::Zero();  ///< footprint, metres
  bool movable = false;                                 ///< people push it about
};

[[nodiscard]] Furniture make_desk(Random& random);     ///< top, legs, drawers, monitors, clutter
[[nodiscard]] Furniture make_chair(Random& random);    ///< seat, back, four legs or a foot
[[nodiscard]] Furniture make_shelf(Random& random);    ///< boards with boxes of random sizes, partly empty
[[nodiscard]] Furniture make_cabinet(Random& random);  ///< closed, doors set in
[[nodiscard]] Furniture make_plant(Random& random);    ///< pot and a few clumps of leaves
[[nodiscard]] Furniture make_box(Random& random);      ///< parcels on the floor, some stacked or tilted
[[nodiscard]] Furniture make_pillar(Random& random, double height_m);
[[nodiscard]] Furniture make_partition(Random& random);  ///< free-standing wall

}  // namespace liloc::sim
