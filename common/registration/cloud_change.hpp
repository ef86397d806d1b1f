#pragma once
#include <cstdint>
#include <vector>

#include "common/geometry/cloud.hpp"

namespace liloc {

/// What became of a cloud's points. Most of a room stays as it is from one moment to the next.
struct CloudChange {
  static constexpr std::int32_t kGone = -1;
  std::vector<std::int32_t> now;      ///< of each point before: its index now, rising, or kGone
  std::vector<Eigen::Vector3f> gone;  ///< points that are not there any more
  std::vector<std::uint32_t> fresh;   ///< indices of points that were not there before, rising
};

/// A point stays if its place and normal are the same to the last bit and points that stay keep their order; as
/// many stay as can.
[[nodiscard]] CloudChange change_between(const Cloud& before, const Cloud& now);

/// Places within a box of +-`reach_m` about any of some points; may err towards yes by 0.1 m, or more where
/// the points span more than a building. Immutable.
class Vicinity {
 public:
  /// Finite points.
  Vicinity(const std::vector<Eigen::Vector3f>& points, double reach_m);
  [[nodiscard]] bool has(const Eigen::Vector3f& p) const {
    const Eigen::Array3f q = (p - origin_).array() * inverse_;
    if (cells_.empty() || !((q >= 0).all() && (q < size_.cast<float>()).all())) return false;
    const Eigen::Array3i cell = q.cast<int>();
    return cells_[index(cell.x(), cell.y(), cell.z())] != 0;
  }

 private:
  [[nodiscard]] std::size_t index(int x, int y, int z) const {
    const auto size = size_.cast<std::size_t>();
    return (static_cast<std::size_t>(z) * size.y() + static_cast<std::size_t>(y)) * size.x() +
           static_cast<std::size_t>(x);
  }
  float inverse_ = 1;
  Eigen::Vector3f origin_ = Eigen::Vector3f::Zero();
  Eigen::Array3i size_ = Eigen::Array3i::Zero();
  std::vector<std::uint8_t> cells_;
};

}  // namespace liloc
