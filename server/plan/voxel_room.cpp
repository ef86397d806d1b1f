#include "server/plan/voxel_room.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/geometry/voxel.hpp"
#include "common/registration/points/normals.hpp"

namespace liloc::plan {
namespace {

using Eigen::Vector3f;
using Eigen::Vector3i;

// By hand, all of them.
constexpr std::size_t kFewestVoxels = 500;           // a bare room of 2 x 2 m has 2000
constexpr double kSmallest_m = 1, kLargest_m = 250;  // longest side; a room in millimetres is 4000 long
constexpr double kMostCells = 60e6;                  // 5 bytes each: a hall of 240 x 240 x 10 m
constexpr std::size_t kStray = 1000;                 // one point in so many may lie anywhere
constexpr float kNearest_m = 0.2F;                   // of a hit: a sensor may hang against a voxel
constexpr std::uint8_t kFarthest = 255;              // cells
constexpr float kOver = 1e-4F;                       // m beyond a cell's border, so that rounding steps over it

struct Bounds {
  Vector3f low, high;
};

/// Per axis without the outermost thousandth: a few stray points do not make a room large.
Bounds bounds_of(const Cloud& cloud) {
  Bounds bounds{Vector3f::Zero(), Vector3f::Zero()};
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> values;
    values.reserve(cloud.size());
    for (const Vector3f& p : cloud.points)
      if (p.allFinite()) values.push_back(p[axis]);
    if (values.empty()) return bounds;
    const auto cut = static_cast<std::ptrdiff_t>(values.size() / kStray);
    std::nth_element(values.begin(), values.begin() + cut, values.end());
    bounds.low[axis] = values[static_cast<std::size_t>(cut)];
    std::nth_element(values.begin(), values.end() - 1 - cut, values.end());
    bounds.high[axis] = *(values.end() - 1 - cut);
  }
  return bounds;
}

/// The points within bounds that have neighbours, one per cell of a grid that begins at `low`, with normals.
Cloud surfaces_of(const Cloud& scan, const Bounds& bounds) {
  Cloud shifted;  // the grid's origin is the frame's, so that voxels are those of the grid
  for (const Vector3f& p : scan.points)
    if ((p.array() >= bounds.low.array()).all() && (p.array() < bounds.high.array()).all())
      shifted.points.emplace_back(p - bounds.low);
  Cloud thin = with_normals(voxel_downsample(shifted, kVoxel_m), Vector3f::Zero(), {2.5 * kVoxel_m, 5});
  for (Vector3f& p : thin.points) p += bounds.low;
  return thin;
}

}  // namespace

Result<VoxelRoom> VoxelRoom::create(const Cloud& scan_map) {
  Bounds bounds = bounds_of(scan_map);
  const double longest_m = (bounds.high - bounds.low).maxCoeff();
  if (scan_map.empty() || !(longest_m >= kSmallest_m && longest_m <= kLargest_m))
    return fail("the scan spans {:.3g} m, of {} to {}; is it in metres?", longest_m, kSmallest_m, kLargest_m);
  bounds.low.array() -=
      static_cast<float>(1.5 * kVoxel_m);               // floor and two walls in the middle of their voxels:
  bounds.high.array() += static_cast<float>(kVoxel_m);  // noise does not make them two layers
  const Vector3i size =
      ((bounds.high - bounds.low) / static_cast<float>(kVoxel_m)).array().ceil().cast<int>() + 1;
  if (size.cast<double>().prod() > kMostCells)
    return fail("the scan spans {:.0f} x {:.0f} x {:.0f} m, over {:.0f} million voxels; give a part of it",
                0.1 * size.x(), 0.1 * size.y(), 0.1 * size.z(), 1e-6 * kMostCells);
  Cloud surfaces = surfaces_of(scan_map, bounds);
  if (surfaces.size() < kFewestVoxels)
    return fail("the scan has {} voxels of {} m on surfaces, of at least {}; give a denser one",
                surfaces.size(), kVoxel_m, kFewestVoxels);
  return VoxelRoom(std::move(surfaces), bounds.low, size);
}

VoxelRoom::VoxelRoom(Cloud cloud_map, const Vector3f& low_map, const Vector3i& size)
    : cloud_(std::move(cloud_map)), low_(low_map), size_(size) {
  const auto cells = static_cast<std::size_t>(size.x()) * static_cast<std::size_t>(size.y()) *
                     static_cast<std::size_t>(size.z());
  voxel_at_.assign(cells, -1);
  distance_.assign(cells, kFarthest);
  for (std::size_t i = 0; i < cloud_.size(); ++i) {
    const std::size_t at = index_of(cell_of(cloud_.points[i] - low_, 1.0F / static_cast<float>(kVoxel_m)));
    voxel_at_[at] = static_cast<std::int32_t>(i);
    distance_[at] = 0;
  }
  measure_distances();
}

/// Chebyshev distances, exact, in a pass forth and one back over the neighbours that come before and after.
void VoxelRoom::measure_distances() {
  const auto relax = [&](const Vector3i& cell, int side) {
    std::uint8_t& own = distance_[index_of(cell)];
    for (int k = 0; k < 13; ++k) {  // half of the 26 neighbours: those that a row-by-row walk meets earlier
      const Vector3i step(k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1);
      const Vector3i neighbour = cell + side * step;
      if (!inside(neighbour)) continue;
      own = std::min<std::uint8_t>(
          own, static_cast<std::uint8_t>(std::min<int>(kFarthest, distance_[index_of(neighbour)] + 1)));
    }
  };
  for (int z = 0; z < size_.z(); ++z)
    for (int y = 0; y < size_.y(); ++y)
      for (int x = 0; x < size_.x(); ++x) relax({x, y, z}, 1);
  for (int z = size_.z(); z-- > 0;)
    for (int y = size_.y(); y-- > 0;)
      for (int x = size_.x(); x-- > 0;) relax({x, y, z}, -1);
}

std::optional<VoxelRoom::Hit> VoxelRoom::first_hit(const Vector3f& from_map, const Vector3f& direction_map,
                                                   float range_m) const {
  const auto size_m = static_cast<float>(kVoxel_m);
  const Vector3f from = (from_map - low_) / size_m;  // in cells
  const float range = range_m / size_m;
  Vector3f inverse;
  for (int axis = 0; axis < 3; ++axis)
    inverse[axis] = 1 / (std::abs(direction_map[axis]) > 1e-9F ? direction_map[axis] : 1e-9F);
  float t = kNearest_m / size_m;
  while (t < range) {
    const Vector3f p = from + t * direction_map;
    const Vector3i cell = p.array().floor().cast<int>();
    if (!inside(cell)) return std::nullopt;
    const std::size_t at = index_of(cell);
    const std::uint8_t free_cells = distance_[at];
    if (free_cells == 0) {
      const auto voxel = static_cast<Surface>(voxel_at_[at]);
      const bool behind = cloud_.normals[voxel].dot(direction_map) > 0;
      return Hit{2 * voxel + (behind ? 1U : 0U), t * size_m};
    }
    if (free_cells > 1) {  // so far nothing is, whichever way
      t += static_cast<float>(free_cells - 1);
      continue;
    }
    float leave = range;
    for (int axis = 0; axis < 3; ++axis) {
      const float border = static_cast<float>(cell[axis]) + (inverse[axis] > 0 ? 1.0F : 0.0F);
      leave = std::min(leave, (border - p[axis]) * inverse[axis]);
    }
    t += std::max(leave, 0.0F) + kOver / size_m;
  }
  return std::nullopt;
}

bool VoxelRoom::occupied(const Vector3f& p_map) const {
  const Vector3i cell = cell_of(p_map - low_, 1.0F / static_cast<float>(kVoxel_m));
  return inside(cell) && distance_[index_of(cell)] == 0;
}

}  // namespace liloc::plan
