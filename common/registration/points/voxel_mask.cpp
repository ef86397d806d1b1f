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
constexpr double kLeastApart_m = 1;       // a quarter of what is far, where that is needed; by hand
constexpr float kRounding_m = 1e-3F;      // above what floats round indoors; by hand

Eigen::AlignedBox3f box_of(const std::vector<Eigen::Vector3f>& points, const Region& region) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : points)
    if (holds(region, p)) box.extend(p);
  return box;
}

/// That cover the box and what is in reach; 0 of an empty one.
double cells_of(const Eigen::AlignedBox3f& box, double reach_m) {
  if (box.isEmpty()) return 0;
  const auto reach = static_cast<float>(reach_m);
  return (box.sizes().array() + 2 * reach).cast<double>().prod() / std::pow(kCell_m, 3);
}

}  // namespace

VoxelMask::VoxelMask(const std::vector<Eigen::Vector3f>& points, double reach_m)
    : VoxelMask(points, reach_m, Margin::none) {}

VoxelMask VoxelMask::covering(const std::vector<Eigen::Vector3f>& points, double reach_m) {
  return {points, reach_m, Margin::cell};
}

VoxelMask::VoxelMask(const std::vector<Eigen::Vector3f>& points, double reach_m, Margin margin) {
  const double cells = cells_of(box_of(points, everywhere()), reach_m);
  const std::vector<Region> regions = cells <= kMostCells
                                          ? std::vector{everywhere()}
                                          : regions_of(points, 4 * std::max(reach_m, kLeastApart_m));
  for (std::size_t k = 0; k < regions.size(); ++k)
    (k == 0 ? *this : beyond_.emplace_back()).cover(points, regions[k], reach_m, margin);
}

/// One grid over the points of a region.
void VoxelMask::cover(const std::vector<Eigen::Vector3f>& points, const Region& region, double reach_m,
                      Margin margin) {
  const Eigen::AlignedBox3f box = box_of(points, region);
  if (box.isEmpty()) return;
  auto reach = static_cast<float>(reach_m);
  const double cells = cells_of(box, reach_m);
  const double cell_m = kCell_m * std::cbrt(std::max(1.0, cells / kMostCells));
  inverse_ = static_cast<float>(1.0 / cell_m);
  if (margin == Margin::cell) reach += static_cast<float>(kHalfDiagonal * cell_m) + kRounding_m;
  origin_ = box.min().array() - reach;
  const Eigen::Vector3f size_m = box.sizes().array() + 2 * reach;
  size_ = (size_m * inverse_).array().ceil().cast<int>().max(1);
  extent_ = size_.cast<float>();
  cells_.assign(index({0, 0, size_.z()}), 0);
  for (const Eigen::Vector3f& p : points)
    if (holds(region, p)) stamp((p - origin_).array(), reach);
}

bool VoxelMask::at_beyond(const Eigen::Vector3f& p) const {
  return std::ranges::any_of(beyond_, [&](const VoxelMask& mask) { return mask.at(p); });
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
