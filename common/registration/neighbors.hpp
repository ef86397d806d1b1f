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
    for (const Run& run : table_) {
      if (run.end == 0) continue;
      gather(cell_of(sorted_[run.begin], inverse_), &candidates);
      visit(std::span<const std::uint32_t>(index_.data() + run.begin, run.end - run.begin), candidates);
    }
  }

  /// The points within the radius of one point, itself among them, in fixed order.
  struct Neighborhood {
    std::span<const std::uint32_t> index;
    std::span<const float> squared;  ///< distance
  };
  /// Calls visit(index of a point, its neighborhood) for each point: several times cheaper than to query for
  /// each, since the points of a cell share their candidates.
  template <class Visit>
  void for_each_neighborhood(Visit&& visit) const {
    Points candidates;
    Selection near;
    for (const Run& run : table_) {
      if (run.end == 0) continue;
      gather(cell_of(sorted_[run.begin], inverse_), &candidates);
      for (std::uint32_t i = run.begin; i < run.end; ++i) {
        visit(index_[i], select(candidates, sorted_[i], &near));
      }
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

  /// The points of a cell and its 26 neighbours.
  void gather(const Eigen::Vector3i& centre, Points* points) const;
  /// Those of them within the radius of `p`, kept in `near`, whose memory only grows.
  struct Selection {
    std::vector<std::uint32_t> index;
    std::vector<float> squared;
  };
  [[nodiscard]] Neighborhood select(const Points& points, const Eigen::Vector3f& p, Selection* near) const;

  float radius_, inverse_, squared_radius_;
  std::vector<Eigen::Vector3f> sorted_;
  std::vector<std::uint32_t> index_;
  std::vector<Run> table_;  ///< open addressing; `end` 0 marks an empty slot
  int shift_ = 0;
};

}  // namespace liloc
