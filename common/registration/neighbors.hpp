#pragma once
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "common/geometry/voxel.hpp"

namespace liloc {

/// Finds the points within one fixed radius. Points are sorted by cells of that radius and the cells hashed, so
/// a query reads 27 short runs of memory. The points are copied, finite ones only are found; any thread may
/// query.
class RadiusSearch {
 public:
  RadiusSearch(const std::vector<Eigen::Vector3f>& points, double radius_m);

  [[nodiscard]] float radius_m() const { return radius_; }

  /// Calls visit(index into the given points, squared distance) for each point within the radius, in fixed
  /// order.
  template <class Visit>
  void for_each(const Eigen::Vector3f& query, Visit&& visit) const {
    const Eigen::Vector3i centre = cell_of(query, inverse_);
    for (int dz = -1; dz <= 1; ++dz)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx) {
          const Run* run = find(cell_key(centre + Eigen::Vector3i(dx, dy, dz)));
          if (run == nullptr) continue;
          for (std::uint32_t i = run->begin; i < run->end; ++i) {
            const float squared = (sorted_[i] - query).squaredNorm();
            if (squared <= squared_radius_) visit(index_[i], squared);
          }
        }
  }

  /// Calls visit(indices of the cell's points, visitor of candidates) for each occupied cell; the visitor calls
  /// its argument with every point of the cell and its 26 neighbours: all that can lie within the radius of any
  /// of them.
  template <class Visit>
  void for_each_cell(Visit&& visit) const {
    for (const Run& run : table_) {
      if (run.end == 0) continue;
      const std::span<const std::uint32_t> own(index_.data() + run.begin, run.end - run.begin);
      const Eigen::Vector3i centre = cell_of(sorted_[run.begin], inverse_);
      visit(own, [&](auto&& take) {
        for (int dz = -1; dz <= 1; ++dz)
          for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx)
              if (const Run* near = find(cell_key(centre + Eigen::Vector3i(dx, dy, dz))))
                for (std::uint32_t i = near->begin; i < near->end; ++i) take(sorted_[i]);
      });
    }
  }

  struct Neighbor {
    std::uint32_t index;
    float squared_distance;
  };
  [[nodiscard]] std::optional<Neighbor> nearest(const Eigen::Vector3f& query) const;

 private:
  struct Run {
    std::uint64_t key;
    std::uint32_t begin, end;
  };
  [[nodiscard]] const Run* find(std::uint64_t key) const {
    std::size_t slot = (key * 0x9E3779B97F4A7C15ULL) >> shift_;
    while (table_[slot].end != 0) {
      if (table_[slot].key == key) return &table_[slot];
      slot = (slot + 1) & (table_.size() - 1);
    }
    return nullptr;
  }

  float radius_, inverse_, squared_radius_;
  std::vector<Eigen::Vector3f> sorted_;
  std::vector<std::uint32_t> index_;
  std::vector<Run> table_;  ///< open addressing; `end` 0 marks an empty slot
  int shift_ = 0;
};

}  // namespace liloc
