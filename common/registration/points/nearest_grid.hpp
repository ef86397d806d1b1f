#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "common/geometry/regions.hpp"
#include "common/registration/points/cloud_change.hpp"
#include "common/registration/points/vectors.hpp"

namespace liloc {

/// Answers "which point is nearest?" with one table look-up: each cell within `reach_m` of a point holds the
/// index of the point nearest to the cell's centre. Cells lie in blocks of 8x8x8 that exist only near points,
/// so memory grows with surfaces, not with volume; regions that lie far apart have a grid each. Immutable; any
/// thread may ask.
class NearestGrid {
 public:
  static constexpr std::int32_t kNone = -1;

  NearestGrid() = default;
  /// Non-finite points are left out.
  NearestGrid(const std::vector<Eigen::Vector3f>& points, double cell_m, double reach_m);
  /// The same grid, sooner, from that of the points before, for the same cell and reach.
  NearestGrid(const std::vector<Eigen::Vector3f>& points, double cell_m, double reach_m,
              const NearestGrid& before, const CloudChange& change);

  /// Index of a point whose distance is at most half a cell diagonal above the least, or kNone beyond reach.
  [[nodiscard]] std::int32_t nearest(const Eigen::Vector3f& p) const {
    const Eigen::Vector3f q = (p - origin_) * inverse_;
    if (!((q.array() >= 0).all() && (q.array() < extent_.array()).all()))
      return beyond_.empty() ? kNone : nearest_beyond(p);
    const Eigen::Vector3i cell = q.cast<int>();
    const std::int32_t block = blocks_[block_index(cell)];
    return block == kNone ? kNone : cells_[static_cast<std::size_t>(block)][cell_index(cell)];
  }
  /// The same for many points, each moved by `shift`.
  void nearest(const PointRun& points, const Eigen::Vector3f& shift, std::int32_t* indices) const;

 private:
  using Block = std::array<std::int32_t, 512>;

  [[nodiscard]] std::size_t block_index(const Eigen::Vector3i& cell) const {
    return (static_cast<std::size_t>(cell.z() >> 3) * static_cast<std::size_t>(block_count_.y()) +
            static_cast<std::size_t>(cell.y() >> 3)) *
               static_cast<std::size_t>(block_count_.x()) +
           static_cast<std::size_t>(cell.x() >> 3);
  }
  [[nodiscard]] static std::size_t cell_index(const Eigen::Vector3i& cell) {
    return static_cast<std::size_t>((cell.z() & 7) << 6 | (cell.y() & 7) << 3 | (cell.x() & 7));
  }
  /// What grids are made from where there were others before, or null.
  struct Earlier {
    const NearestGrid* grid;
    const CloudChange* change;
  };
  void make(const std::vector<Eigen::Vector3f>& points, double cell_m, double reach_m, const Earlier& earlier);
  void make_region(const std::vector<Eigen::Vector3f>& points, const Region& region, double cell_m,
                   double reach_m, const Earlier& earlier);
  [[nodiscard]] std::int32_t nearest_beyond(const Eigen::Vector3f& p) const;
  void lay_out(const std::vector<Eigen::Vector3f>& points, const Region& region, double cell_m, double reach_m);
  void take_over(const NearestGrid& before, const std::vector<std::int32_t>& now);
  std::int32_t& cell_at(const Eigen::Vector3i& cell);
  template <class Visit>
  void for_each_in_reach(const Eigen::Vector3f& point, const Visit& visit) const;
  [[nodiscard]] float squared_distance(const Eigen::Vector3i& cell, const Eigen::Vector3f& point) const;
  void stamp(const std::vector<Eigen::Vector3f>& points, std::size_t index);
  void fill_left(const std::vector<Eigen::Vector3f>& points, std::size_t index);

  float cell_ = 0, reach_ = 0, inverse_ = 1;
  Eigen::Vector3f origin_ = Eigen::Vector3f::Zero(), extent_ = Eigen::Vector3f::Zero();  ///< extent in cells
  Eigen::Vector3i block_count_ = Eigen::Vector3i::Zero();
  std::vector<std::int32_t> blocks_;  ///< and one more, of what lies outside
  std::vector<Block> cells_;
  std::vector<NearestGrid> beyond_;  ///< those of the other regions
};

}  // namespace liloc
