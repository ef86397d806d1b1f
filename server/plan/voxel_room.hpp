#pragma once
// A scanned room as voxels that have sides, and rays through it.
#include <cstdint>
#include <optional>
#include <vector>

#include "common/geometry/cloud.hpp"

namespace liloc::plan {

/// Of the room that rays are cast through: above the gaps of a scan (a point every 4 to 8 cm), below furniture.
/// By hand.
constexpr double kVoxel_m = 0.1;

/// One side of an occupied voxel: twice its number, plus 1 for the side that its normal points away from. What
/// is seen from one side of a thin wall is not seen from the other.
using Surface = std::uint32_t;

/// Immutable; any thread may read it.
class VoxelRoom {
 public:
  /// `scan_map`: points in metres, z up. What hangs alone in the air is left out. Errors: fewer than 500 voxels
  /// on surfaces, a room of under 1 m or over 250 m (probably not in metres), more space than 60 million
  /// voxels.
  [[nodiscard]] static Result<VoxelRoom> create(const Cloud& scan_map);

  struct Hit {
    Surface surface = 0;
    float distance_m = 0;
  };
  /// What a ray meets first, from 0.2 m on. `direction_map` is unit.
  [[nodiscard]] std::optional<Hit> first_hit(const Eigen::Vector3f& from_map,
                                             const Eigen::Vector3f& direction_map, float range_m) const;

  /// Whether something is in the point's voxel; outside the room nothing is.
  [[nodiscard]] bool occupied(const Eigen::Vector3f& p_map) const;
  [[nodiscard]] std::size_t voxels() const { return cloud_.size(); }
  [[nodiscard]] std::size_t surfaces() const { return 2 * cloud_.size(); }
  [[nodiscard]] const Eigen::Vector3f& point_map(Surface surface) const { return cloud_.points[surface / 2]; }
  /// Unit, out of this side.
  [[nodiscard]] Eigen::Vector3f normal_map(Surface surface) const {
    return surface % 2 == 0 ? cloud_.normals[surface / 2] : Eigen::Vector3f(-cloud_.normals[surface / 2]);
  }
  /// A point per voxel, normals to either side.
  [[nodiscard]] const Cloud& cloud_map() const { return cloud_; }
  [[nodiscard]] const Eigen::Vector3f& low_map() const { return low_; }
  [[nodiscard]] Eigen::Vector3f high_map() const { return low_ + kVoxel_m * size_.cast<float>(); }

 private:
  VoxelRoom(Cloud cloud_map, const Eigen::Vector3f& low_map, const Eigen::Vector3i& size);
  void measure_distances();
  [[nodiscard]] std::size_t index_of(const Eigen::Vector3i& cell) const {
    return static_cast<std::size_t>(cell.x()) +
           static_cast<std::size_t>(size_.x()) *
               (static_cast<std::size_t>(cell.y()) +
                static_cast<std::size_t>(size_.y()) * static_cast<std::size_t>(cell.z()));
  }
  [[nodiscard]] bool inside(const Eigen::Vector3i& cell) const {
    return (cell.array() >= 0).all() && (cell.array() < size_.array()).all();
  }

  Cloud cloud_;
  Eigen::Vector3f low_;
  Eigen::Vector3i size_;                ///< cells along each axis
  std::vector<std::int32_t> voxel_at_;  ///< per cell, -1: free
  std::vector<std::uint8_t> distance_;  ///< per cell: cells to the nearest occupied one by the longest axis
};

}  // namespace liloc::plan
