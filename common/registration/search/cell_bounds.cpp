#include "common/registration/search/cell_bounds.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

namespace liloc {
namespace {

constexpr double kFarthest_m = 1e5;   // as valid_pose has it
constexpr double kLeastSd = 0.05;     // a handful of alike views does not make all others wrong; by hand
constexpr double kConfidence = 1.96;  // 95 % of a normal distribution; paper, section 5.2

std::optional<GridCell> cell_at(const Eigen::Vector3d& place_map) {
  if (!place_map.allFinite() || place_map.cwiseAbs().maxCoeff() > kFarthest_m) return std::nullopt;
  return GridCell{static_cast<int>(std::lround(place_map.x() / CellBounds::kCell_m)),
                  static_cast<int>(std::lround(place_map.y() / CellBounds::kCell_m))};
}

bool is_share(double value) {
  return value >= 0 && value <= 1;  // false for NaN
}

}  // namespace

void CellBounds::learn(const Eigen::Vector3d& place_map, double fitness) {
  const auto at = cell_at(place_map);
  if (!at || !is_share(fitness)) return;
  if (!cells_.contains(*at) && cells_.size() >= kMostCells) return;
  Cell& cell = cells_[*at];
  cell.count = std::min(cell.count + 1, kMostCounted);
  const double share = 1.0 / cell.count, off = fitness - cell.mean;  // West's running moments
  cell.mean += share * off;
  cell.variance = (1 - share) * (cell.variance + share * off * off);
}

bool CellBounds::plausible(const Eigen::Vector3d& place_map, double fitness) const {
  const auto at = cell_at(place_map);
  if (!at || !is_share(fitness)) return false;
  const auto found = cells_.find(*at);
  if (found == cells_.end() || found->second.count < kFewest) return true;
  const double sd = std::max(std::sqrt(found->second.variance), kLeastSd);
  return std::abs(fitness - found->second.mean) <= kConfidence * sd;
}

bool CellBounds::restore(const GridCell& at, const Cell& cell) {
  const int farthest = static_cast<int>(kFarthest_m / kCell_m) + 1;
  const bool sound = std::abs(at.x) <= farthest && std::abs(at.y) <= farthest && cell.count >= 1 &&
                     cell.count <= kMostCounted && is_share(cell.mean) && is_share(cell.variance);
  return sound && cells_.size() < kMostCells && cells_.emplace(at, cell).second;
}

}  // namespace liloc
