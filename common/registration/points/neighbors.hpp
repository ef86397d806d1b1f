#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "common/geometry/voxel.hpp"

namespace liloc {

/// Finds the points within one fixed radius of each point. Points are sorted by cells of that radius, x
/// fastest, so that what lies about a cell are nine runs of memory, and from cell to cell each run only moves
/// on. The points are copied, finite ones only are found; any thread may ask.
class RadiusSearch {
 public:
  RadiusSearch(const std::vector<Eigen::Vector3f>& points, double radius_m);

  [[nodiscard]] float radius_m() const { return radius_; }

  /// Points about a place as arrays, so that the compiler can work on many at a time.
  struct Points {
    std::vector<std::uint32_t> index;  ///< into the given points
    std::vector<float> x, y, z;
  };
  /// Calls visit(indices of the cell's points, candidates) for each occupied cell; the candidates are the
  /// points of the cell and its 26 neighbours: all that can lie within the radius of any of them.
  template <class Visit>
  void for_each_cell(Visit&& visit) const {
    Points candidates;
    Rows rows{};
    for (const Cell& cell : cells_) {
      gather(cell, &rows, &candidates);
      visit(std::span<const std::uint32_t>(sorted_.index.data() + cell.begin, cell.end - cell.begin),
            candidates);
    }
  }

  /// The points within the radius of one point, itself among them, in fixed order.
  struct Neighborhood {
    std::span<const std::uint32_t> index;
    std::span<const float> squared;  ///< distance
  };
  /// Calls visit(index of a point, its neighborhood) for each point; the points of a cell share their
  /// candidates.
  template <class Visit>
  void for_each_neighborhood(Visit&& visit) const {
    Points candidates;
    Rows rows{};
    Selection near;
    for (const Cell& cell : cells_) {
      gather(cell, &rows, &candidates);
      for (std::uint32_t i = cell.begin; i < cell.end; ++i)
        visit(sorted_.index[i], select(candidates, {sorted_.x[i], sorted_.y[i], sorted_.z[i]}, &near));
    }
  }

 private:
  struct Cell {
    std::uint64_t key;
    std::uint32_t begin, end;  ///< of its points
  };
  using Rows = std::array<std::size_t, 9>;  ///< the first cell in reach of each row about the last cell

  /// The points of a cell and its 26 neighbours; `rows` of the cell before, or zeros.
  void gather(const Cell& cell, Rows* rows, Points* points) const;
  /// Those of them within the radius of `p`, kept in `near`, whose memory only grows.
  struct Selection {
    std::vector<std::uint32_t> index;
    std::vector<float> squared;
  };
  [[nodiscard]] Neighborhood select(const Points& points, const Eigen::Vector3f& p, Selection* near) const;

  float radius_, squared_radius_;
  Points sorted_;            ///< by cell
  std::vector<Cell> cells_;  ///< by rising key
};

}  // namespace liloc
