#pragma once
#include <cstdint>

#include "common/geometry/cloud.hpp"

namespace liloc {

/// Integer cell of a point: floor(p / size).
[[nodiscard]] inline Eigen::Vector3i cell_of(const Eigen::Vector3f& p, float inverse_size) {
  return (p * inverse_size).array().floor().cast<int>();
}

/// A cell as one number (21 bits an axis: +-52 km at 0.05 m).
[[nodiscard]] inline std::uint64_t cell_key(const Eigen::Vector3i& cell) {
  constexpr std::int64_t kHalf = 1 << 20, kMask = (1 << 21) - 1;  ///< 21 bits of an axis: three fit 64
  const auto part = [](int i) { return static_cast<std::uint64_t>((i + kHalf) & kMask); };
  return part(cell.x()) | part(cell.y()) << 21 | part(cell.z()) << 42;
}

/// One point per occupied voxel: the mean of the points in it, and the mean normal, made unit again, where
/// there are normals. Voxels come in the order in which the input first enters them. Non-finite points are
/// dropped.
[[nodiscard]] Cloud voxel_downsample(const Cloud& cloud, double voxel_size_m);

/// The same without normals, and at most `most_points` of it: each block of 4 x 4 x 4 voxels keeps no more than
/// so many, spread evenly. Large faces are thinned; what is rare, such as edges, legs and far corners, stays.
/// In the order of blocks.
[[nodiscard]] Cloud voxel_downsample(const Cloud& cloud, double voxel_size_m, std::size_t most_points);

}  // namespace liloc
