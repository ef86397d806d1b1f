#include "common/registration/points/voxel_mask.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace liloc {
namespace {

// By hand; the second bounds memory.
constexpr double kCell_m = 0.08, kMostCells = 4e6;
constexpr double kHalfDiagonal = 0.8661;  // of a cell; rounded up
constexpr float kRounding_m = 1e-3F;      // above what floats round indoors; by hand

}  // namespace

VoxelMask::VoxelMask(const std::vector<Eigen::Vector3f>& points, double reach_m)
    : VoxelMask(points, reach_m, Margin::none) {}

VoxelMask VoxelMask::covering(const std::vector<Eigen::Vector3f>& points, double reach_m) {
  return {points, reach_m, Margin::cell};
}

VoxelMask::VoxelMask(const std::vector<Eigen::Vector3f>& points, double reach_m, Margin margin) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : points)
    if (p.allFinite()) box.extend(p);
  if (box.isEmpty()) return;
  auto reach = static_cast<float>(reach_m);
  const double cells = (box.sizes().array() + 2 * reach).cast<double>().prod() / std::pow(kCell_m, 3);
  const double cell_m = kCell_m * std::cbrt(std::max(1.0, cells / kMostCells));
  inverse_ = static_cast<float>(1.0 / cell_m);
  if (margin == Margin::cell) reach += static_cast<float>(kHalfDiagonal * cell_m) + kRounding_m;
  origin_ = box.min().array() - reach;
  const Eigen::Vector3f size_m = box.sizes().array() + 2 * reach;
  size_ = (size_m * inverse_).array().ceil().cast<int>().max(1);
  extent_ = size_.cast<float>();
  cells_.assign(index({0, 0, size_.z()}), 0);
  for (const Eigen::Vector3f& p : points)
    if (p.allFinite()) stamp((p - origin_).array(), reach);
}

/// A ball, row by row: the cells whose centres lie within reach.
void VoxelMask::stamp(const Eigen::Array3f& q_m, float reach_m) {
  const Eigen::Array3f q = q_m * inverse_ - 0.5F;  // in cells, of centres
  const float reach = reach_m * inverse_;
  const auto rows_of = [&](float middle, float half, int size) {
    return std::pair{std::max(0, static_cast<int>(std::ceil(middle - half))),
                     std::min(size - 1, static_cast<int>(std::floor(middle + half)))};
  };
  const auto [z_lo, z_hi] = rows_of(q.z(), reach, size_.z());
  for (int z = z_lo; z <= z_hi; ++z) {
    const float off_z = static_cast<float>(z) - q.z(),
                disk = std::sqrt(std::max(0.0F, reach * reach - off_z * off_z));
    const auto [y_lo, y_hi] = rows_of(q.y(), disk, size_.y());
    for (int y = y_lo; y <= y_hi; ++y) {
      const float off_y = static_cast<float>(y) - q.y();
      const auto [x_lo, x_hi] =
          rows_of(q.x(), std::sqrt(std::max(0.0F, disk * disk - off_y * off_y)), size_.x());
      if (x_lo <= x_hi)
        std::fill_n(cells_.begin() + static_cast<std::ptrdiff_t>(index({x_lo, y, z})), x_hi - x_lo + 1,
                    std::uint8_t{1});
    }
  }
}

}  // namespace liloc
