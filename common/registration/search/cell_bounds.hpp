#pragma once
#include <map>
#include <tuple>

#include "common/geometry/pose.hpp"

namespace liloc {

/// A square of the grid over the map's x and y.
struct GridCell {
  int x = 0, y = 0;
  bool operator<(const GridCell& other) const { return std::tie(x, y) < std::tie(other.x, other.y); }
};

/// The fitness of right registrations, per cell of the grid: mean -+ 1.96 standard deviations of what was
/// verified there (the paper, section 5.2). Less fits too badly to be right; more is a flat patch that slid
/// onto a plane. Old registrations are forgotten gradually, since rooms change. Bounded; not thread-safe.
class CellBounds {
 public:
  struct Cell {
    int count = 0;  ///< registrations, up to kMostCounted
    double mean = 0, variance = 0;
  };
  static constexpr int kFewest = 10;                 ///< fewer registrations bound nothing; by hand
  static constexpr int kMostCounted = 200;           ///< older ones fade: rooms change; by hand
  static constexpr std::size_t kMostCells = 10'000;  ///< memory bound: 60 000 m2 of cells; by hand
  static constexpr double kCell_m = 2.5;             ///< as FeatureSearchOptions::cell_m

  /// `place_map`: the middle of the device's cloud; `fitness` 0..1. Values out of range and cells beyond the
  /// most are left out.
  void learn(const Eigen::Vector3d& place_map, double fitness);
  /// False only where enough was learned and `fitness` lies outside of it.
  [[nodiscard]] bool plausible(const Eigen::Vector3d& place_map, double fitness) const;

  [[nodiscard]] const std::map<GridCell, Cell>& cells() const { return cells_; }
  /// Puts a cell back that `cells` gave. False: a value that no learning gives, a cell twice, or too many.
  [[nodiscard]] bool restore(const GridCell& at, const Cell& cell);

 private:
  std::map<GridCell, Cell> cells_;
};

}  // namespace liloc
