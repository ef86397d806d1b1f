#pragma once
#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/geometry/regions.hpp"

namespace liloc {

/// The places within reach of some points, by cells of 0.08 m, or more where a region of them spans more than a
/// building. Immutable.
class VoxelMask {
 public:
  VoxelMask() = default;
  /// The cells whose middle is in reach. Non-finite points are left out.
  VoxelMask(const std::vector<Eigen::Vector3f>& points, double reach_m);
  /// The same with a margin: misses no place in reach, errs towards yes by up to a cell's diagonal.
  [[nodiscard]] static VoxelMask covering(const std::vector<Eigen::Vector3f>& points, double reach_m);

  [[nodiscard]] bool empty() const { return cells_.empty(); }
  [[nodiscard]] bool at(const Eigen::Vector3f& p) const {
    const Eigen::Vector3f q = (p - origin_) * inverse_;
    if (!cells_.empty() && (q.array() >= 0).all() && (q.array() < extent_.array()).all() &&
        cells_[index(q.cast<int>())] != 0)
      return true;
    return !beyond_.empty() && at_beyond(p);
  }
  /// Calls visit(point) in the middle of each cell.
  template <class Visit>
  void for_each_place(const Visit& visit) const {
    std::size_t i = 0;
    for (int z = 0; z < size_.z(); ++z)
      for (int y = 0; y < size_.y(); ++y)
        for (int x = 0; x < size_.x(); ++x)
          if (cells_[i++] != 0)
            visit(Eigen::Vector3f(origin_ + (Eigen::Vector3f(x, y, z).array() + 0.5F).matrix() / inverse_));
    for (const VoxelMask& mask : beyond_) mask.for_each_place(visit);
  }

 private:
  [[nodiscard]] std::size_t index(const Eigen::Vector3i& cell) const {
    return (static_cast<std::size_t>(cell.z()) * static_cast<std::size_t>(size_.y()) +
            static_cast<std::size_t>(cell.y())) *
               static_cast<std::size_t>(size_.x()) +
           static_cast<std::size_t>(cell.x());
  }
  enum class Margin { none, cell };
  VoxelMask(const std::vector<Eigen::Vector3f>& points, double reach_m, Margin margin);
  void cover(const std::vector<Eigen::Vector3f>& points, const Region& region, double reach_m, Margin margin);
  void stamp(const Eigen::Array3f& q_m, float reach_m);
  [[nodiscard]] bool at_beyond(const Eigen::Vector3f& p) const;

  float inverse_ = 1;
  Eigen::Vector3f origin_ = Eigen::Vector3f::Zero(), extent_ = Eigen::Vector3f::Zero();  ///< extent in cells
  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  std::vector<std::uint8_t> cells_;
  std::vector<VoxelMask> beyond_;  ///< those of regions far from this one's
};

}  // namespace liloc
