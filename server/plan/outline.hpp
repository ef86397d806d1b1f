#pragma once
// A floor plan as a drawing of walls, and the bare room that it means.
#include <cstdint>
#include <vector>

#include "common/geometry/cloud.hpp"

namespace liloc::plan {

/// Walls drawn on square cells, row by row; row 0 has the lowest y. Cell (x, y) is at `low + (x, y) * cell_m`.
struct Outline {
  int width = 0, height = 0;
  double cell_m = 0.05;                               ///< half a voxel: walls have no gaps
  Eigen::Vector2d low_map = Eigen::Vector2d::Zero();  ///< of the corner of cell (0, 0)
  std::vector<std::uint8_t> wall;                     ///< 1: a wall

  [[nodiscard]] std::uint8_t& at(int x, int y) {
    return wall[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
};

/// An empty drawing over an area, with a free margin. Errors: over 250 m long (is it in metres?), under 1 m.
[[nodiscard]] Result<Outline> blank_outline(const Eigen::Vector2d& low_map, const Eigen::Vector2d& high_map);

/// Draws a wall between two points, two cells thick, so that slanting ones have no gaps; what lies outside is
/// left out.
void draw_wall(Outline& outline, const Eigen::Vector2d& from_map, const Eigen::Vector2d& to_map);

/// Floor at z = 0, ceiling at `height_m` and the walls' sides towards the inside, as points. Inside is what no
/// way from the border of the drawing leads to. Errors: nothing is (a gap in the outer wall, or none drawn),
/// over 10 000 m2, over 50 million points (walls drawn as hatches).
[[nodiscard]] Result<Cloud> extruded(const Outline& outline, double height_m);

}  // namespace liloc::plan
