#include "proto-tests/sim/site/floor_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

namespace liloc::sim {
namespace {

using Eigen::Vector2d;
constexpr double kCell = 0.1;  // m, of the grid that ways are found on; by hand
constexpr int kStepX[] = {1, -1, 0, 0, 1, 1, -1, -1}, kStepY[] = {0, 0, 1, -1, 1, -1, 1, -1};

bool covers(const Placement& placement, const Vector2d& half, const Vector2d& p, double radius_m) {
  const Vector2d local = Eigen::Rotation2Dd(-placement.yaw_rad) * (p - placement.at);
  return (local.cwiseAbs() - half).cwiseMax(0).norm() < radius_m;
}

}  // namespace

FloorPlan::FloorPlan(const Layout& layout, double radius_m)
    : size_m_(layout.size_m.head<2>()),
      columns_(static_cast<int>(layout.size_m.x() / kCell)),
      rows_(static_cast<int>(layout.size_m.y() / kCell)) {
  free_.assign(static_cast<std::size_t>(columns_ * rows_), 1);
  for (int cell = 0; cell < columns_ * rows_; ++cell) {
    const Vector2d p = centre_of(cell);
    const bool inside = p.x() > radius_m && p.y() > radius_m && p.x() < layout.size_m.x() - radius_m &&
                        p.y() < layout.size_m.y() - radius_m;
    const bool taken = !inside || std::ranges::any_of(layout.items, [&](const Item& item) {
      const Vector2d& half = item.furniture.half_size;
      return covers(item.start, half, p, radius_m) || (item.push && covers(item.push->to, half, p, radius_m));
    });
    if (taken) free_[static_cast<std::size_t>(cell)] = 0;
  }
  keep_largest_part();
}

int FloorPlan::cell_of(const Vector2d& at) const {
  const int x = static_cast<int>(std::floor(at.x() / kCell)), y = static_cast<int>(std::floor(at.y() / kCell));
  return x < 0 || y < 0 || x >= columns_ || y >= rows_ ? -1 : y * columns_ + x;
}

Vector2d FloorPlan::centre_of(int cell) const {
  return {(cell % columns_ + 0.5) * kCell, (cell / columns_ + 0.5) * kCell};
}

bool FloorPlan::is_free(const Vector2d& at) const {
  const int cell = cell_of(at);
  return cell >= 0 && free_[static_cast<std::size_t>(cell)] != 0;
}

void FloorPlan::keep_largest_part() {
  std::vector<std::uint8_t> seen(free_.size(), 0);
  for (int seed = 0; seed < columns_ * rows_; ++seed) {
    if (free_[static_cast<std::size_t>(seed)] == 0 || seen[static_cast<std::size_t>(seed)] != 0) continue;
    std::vector<int> part{seed};
    seen[static_cast<std::size_t>(seed)] = 1;
    for (std::size_t i = 0; i < part.size(); ++i)
      for (int k = 0; k < 4; ++k) {
        const int next = cell_of(centre_of(part[i]) + kCell * Vector2d(kStepX[k], kStepY[k]));
        if (next < 0 || free_[static_cast<std::size_t>(next)] == 0 || seen[static_cast<std::size_t>(next)] != 0)
          continue;
        seen[static_cast<std::size_t>(next)] = 1;
        part.push_back(next);
      }
    if (part.size() > free_cells_.size()) free_cells_ = std::move(part);
  }
  std::ranges::fill(free_, std::uint8_t{0});
  for (const int cell : free_cells_) free_[static_cast<std::size_t>(cell)] = 1;
}

Vector2d FloorPlan::random_place(Random& random) const {
  return centre_of(free_cells_[static_cast<std::size_t>(random.below(static_cast<int>(free_cells_.size())))]);
}

double FloorPlan::distance_to_wall_m(const Vector2d& at) const {
  return std::min(at.minCoeff(), (size_m_ - at).minCoeff());
}

Vector2d FloorPlan::nearest_free(const Vector2d& at) const {
  const int cell = *std::ranges::min_element(
      free_cells_, {}, [&](int candidate) { return (centre_of(candidate) - at).squaredNorm(); });
  return is_free(at) ? at : centre_of(cell);
}

bool FloorPlan::sees(const Vector2d& from, const Vector2d& to) const {
  const int steps = 1 + static_cast<int>((to - from).norm() / (0.5 * kCell));
  for (int i = 0; i <= steps; ++i)
    if (!is_free(from + (to - from) * (static_cast<double>(i) / steps))) return false;
  return true;
}

std::vector<Vector2d> FloorPlan::route(const Vector2d& from, const Vector2d& to) const {
  if (!is_free(from) || !is_free(to)) return {};
  const int start = cell_of(from), goal = cell_of(to);
  std::vector<double> cost(free_.size(), std::numeric_limits<double>::max());
  std::vector<int> parent(free_.size(), -1);
  std::priority_queue<std::pair<double, int>, std::vector<std::pair<double, int>>, std::greater<>> open;  // A*
  cost[static_cast<std::size_t>(start)] = 0;
  open.emplace(0.0, start);
  while (!open.empty() && open.top().second != goal) {
    const int cell = open.top().second;
    open.pop();
    for (int k = 0; k < 8; ++k) {
      const Vector2d step(kStepX[k], kStepY[k]);
      const int next = cell_of(centre_of(cell) + kCell * step);
      if (next < 0 || free_[static_cast<std::size_t>(next)] == 0) continue;
      const double reached = cost[static_cast<std::size_t>(cell)] + kCell * step.norm();
      if (reached >= cost[static_cast<std::size_t>(next)] - 1e-9) continue;
      cost[static_cast<std::size_t>(next)] = reached;
      parent[static_cast<std::size_t>(next)] = cell;
      open.emplace(reached + (centre_of(goal) - centre_of(next)).norm(), next);
    }
  }
  if (open.empty()) return {};
  std::vector<Vector2d> cells{to};
  for (int cell = parent[static_cast<std::size_t>(goal)]; cell >= 0 && cell != start;
       cell = parent[static_cast<std::size_t>(cell)])
    cells.push_back(centre_of(cell));
  cells.push_back(from);
  std::ranges::reverse(cells);
  std::vector<Vector2d> corners{cells.front()};  // pull the string tight: skip what can be seen past
  for (std::size_t i = 0; i + 1 < cells.size();) {
    std::size_t next = i + 1;
    while (next + 1 < cells.size() && sees(cells[i], cells[next + 1])) ++next;
    corners.push_back(cells[next]);
    i = next;
  }
  return corners;
}

}  // namespace liloc::sim
