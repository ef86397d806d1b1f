#include "server/plan/outline.hpp"

#include <algorithm>
#include <cmath>

namespace liloc::plan {
namespace {

// By hand, all of them.
constexpr double kSmallest_m = 1, kLargest_m = 250;
constexpr int kMargin = 3;                       // cells around the drawing, so that outside is one
constexpr double kLeastInside_m2 = 1;            // less is the inside of a letter or of a double wall
constexpr double kMostInside_m2 = 10'000;        // as large as a site may be (common/recording/sensors.cpp)
constexpr std::size_t kMostPoints = 50'000'000;  // 600 MB: a hall of 10 000 m2 and 10 m has 8.6 million

enum Cell : std::uint8_t { kInside = 0, kWall = 1, kOutside = 2, kFacing = 3 };

/// Marks what a way from the border leads to.
void flood_outside(Outline& cells) {
  std::vector<Eigen::Vector2i> todo;
  const auto reach = [&](int x, int y) {
    if (x < 0 || y < 0 || x >= cells.width || y >= cells.height || cells.at(x, y) != kInside) return;
    cells.at(x, y) = kOutside;
    todo.emplace_back(x, y);
  };
  for (int x = 0; x < cells.width; ++x) reach(x, 0), reach(x, cells.height - 1);
  for (int y = 0; y < cells.height; ++y) reach(0, y), reach(cells.width - 1, y);
  while (!todo.empty()) {
    const Eigen::Vector2i c = todo.back();
    todo.pop_back();
    reach(c.x() + 1, c.y()), reach(c.x() - 1, c.y()), reach(c.x(), c.y() + 1), reach(c.x(), c.y() - 1);
  }
}

bool borders_inside(Outline& cells, int x, int y) {
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const int u = x + dx, v = y + dy;
      if (u >= 0 && v >= 0 && u < cells.width && v < cells.height && cells.at(u, v) == kInside) return true;
    }
  return false;
}

/// Makes walls that border the inside kFacing: these alone are seen.
void mark_facing(Outline& cells) {
  for (int y = 0; y < cells.height; ++y)
    for (int x = 0; x < cells.width; ++x)
      if (cells.at(x, y) == kWall && borders_inside(cells, x, y)) cells.at(x, y) = kFacing;
}

std::size_t count_of(const Outline& cells, Cell kind) {
  return static_cast<std::size_t>(std::ranges::count(cells.wall, std::uint8_t{kind}));
}

/// A marked drawing as points, `count` of them.
Cloud raised(Outline& cells, double height_m, int layers, std::size_t count) {
  Cloud cloud;
  cloud.points.reserve(count);
  for (int y = 0; y < cells.height; ++y)
    for (int x = 0; x < cells.width; ++x) {
      const Eigen::Vector2d p = cells.low_map + cells.cell_m * Eigen::Vector2d(x + 0.5, y + 0.5);
      const auto put = [&](double z_m) {
        cloud.points.emplace_back(Eigen::Vector3d(p.x(), p.y(), z_m).cast<float>());
      };
      if (cells.at(x, y) == kInside) {
        put(0);
        put(height_m);
      } else if (cells.at(x, y) == kFacing) {
        for (int k = 0; k <= layers; ++k) put(height_m * k / layers);
      }
    }
  return cloud;
}

}  // namespace

Result<Outline> blank_outline(const Eigen::Vector2d& low_map, const Eigen::Vector2d& high_map) {
  const double longest_m = (high_map - low_map).maxCoeff();
  if (!(longest_m >= kSmallest_m && longest_m <= kLargest_m))
    return fail("the drawing spans {:.3g} m, of {} to {}; correct --scale", longest_m, kSmallest_m, kLargest_m);
  Outline outline;
  outline.low_map = low_map.array() - kMargin * outline.cell_m;
  const Eigen::Vector2d size = (high_map - outline.low_map) / outline.cell_m;
  outline.width = static_cast<int>(std::ceil(size.x())) + kMargin;
  outline.height = static_cast<int>(std::ceil(size.y())) + kMargin;
  outline.wall.assign(static_cast<std::size_t>(outline.width) * static_cast<std::size_t>(outline.height),
                      kInside);
  return outline;
}

void draw_wall(Outline& outline, const Eigen::Vector2d& from_map, const Eigen::Vector2d& to_map) {
  const Eigen::Vector2d from = (from_map - outline.low_map) / outline.cell_m,
                        to = (to_map - outline.low_map) / outline.cell_m;
  if (!from.allFinite() || !to.allFinite()) return;
  const int steps = 1 + static_cast<int>(std::min(2 * (to - from).cwiseAbs().maxCoeff(),
                                                  4.0 * (outline.width + outline.height)));
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d p = from + static_cast<double>(i) / steps * (to - from);
    for (const Eigen::Vector2d& brush :
         {p, Eigen::Vector2d(p.x() + 1, p.y()), Eigen::Vector2d(p.x(), p.y() + 1)})
      if ((brush.array() >= 0).all() && brush.x() < outline.width && brush.y() < outline.height)
        outline.at(static_cast<int>(brush.x()), static_cast<int>(brush.y())) = kWall;
  }
}

Result<Cloud> extruded(const Outline& outline, double height_m) {
  Outline cells = outline;
  flood_outside(cells);
  const std::size_t inside = count_of(cells, kInside);
  const double inside_m2 = static_cast<double>(inside) * cells.cell_m * cells.cell_m;
  if (inside_m2 < kLeastInside_m2)
    return fail("the drawing encloses no room: close the gaps of the outer wall, doors too");
  if (inside_m2 > kMostInside_m2)
    return fail("the drawing encloses {:.0f} m2, over {:.0f}; correct --scale, or draw a part of it", inside_m2,
                kMostInside_m2);
  mark_facing(cells);
  const std::size_t facing = count_of(cells, kFacing);
  const int layers = std::max(1, static_cast<int>(std::lround(height_m / cells.cell_m)));
  const std::size_t count = 2 * inside + facing * static_cast<std::size_t>(layers + 1);
  if (count > kMostPoints)
    return fail(
        "the drawing's {:.0f} m of walls, {:.3g} m high, are {:.0f} million points, over {:.0f}; leave hatches "
        "and "
        "furniture out, or draw a part of it",
        static_cast<double>(facing) * cells.cell_m, height_m, 1e-6 * static_cast<double>(count),
        1e-6 * static_cast<double>(kMostPoints));
  return raised(cells, height_m, layers, count);
}

}  // namespace liloc::plan
