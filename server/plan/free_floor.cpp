#include "server/plan/free_floor.hpp"

#include <algorithm>
#include <cmath>

namespace liloc::plan {
namespace {

using Eigen::Vector3f;

// By hand, all of them.
constexpr float kLevel = 0.8F;           // |normal.z| of floors and ceilings
constexpr double kShareOfRoom = 0.2;     // of the room's columns that a floor or ceiling fills
constexpr double kLeastHeight_m = 1.9;   // from the floor to a ceiling
constexpr double kShareOfLargest = 0.2;  // of the largest part of the floor
constexpr double kClosest_m = 0.4;       // of places

/// A map of columns of voxels, row by row.
struct Columns {
  explicit Columns(const VoxelRoom& room)
      : low(room.low_map().head<2>()),
        width(static_cast<int>(std::lround((room.high_map().x() - low.x()) / kVoxel_m))),
        height(static_cast<int>(std::lround((room.high_map().y() - low.y()) / kVoxel_m))),
        cells(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0) {}

  [[nodiscard]] Eigen::Vector2i of(const Vector3f& p) const {
    return {static_cast<int>((p.x() - low.x()) / kVoxel_m), static_cast<int>((p.y() - low.y()) / kVoxel_m)};
  }
  [[nodiscard]] bool has(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
  [[nodiscard]] int& at(int x, int y) {
    return cells[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)];
  }
  [[nodiscard]] Eigen::Vector2f middle(int x, int y) const {
    return low + static_cast<float>(kVoxel_m) *
                     Eigen::Vector2f(static_cast<float>(x) + 0.5F, static_cast<float>(y) + 0.5F);
  }
  /// Marks all columns within a radius.
  void stamp(const Vector3f& p, double radius_m, int value) {
    const Eigen::Vector2i c = of(p);
    const int reach = static_cast<int>(std::ceil(radius_m / kVoxel_m));
    for (int y = c.y() - reach; y <= c.y() + reach; ++y)
      for (int x = c.x() - reach; x <= c.x() + reach; ++x)
        if (has(x, y) && (middle(x, y) - p.head<2>()).norm() <= radius_m) at(x, y) = value;
  }

  Eigen::Vector2f low;
  int width, height;
  std::vector<int> cells;
};

/// Columns between the outermost filled ones of each row: what walls enclose, whether their floor was scanned
/// or not.
double enclosed(Columns& filled) {
  double count = 0;
  for (int y = 0; y < filled.height; ++y) {
    int first = filled.width, last = -1;
    for (int x = 0; x < filled.width; ++x)
      if (filled.at(x, y) != 0) {
        first = std::min(first, x);
        last = x;
      }
    count += std::max(0, last - first + 1);
  }
  return count;
}

struct Levels {
  double floor_z_m = 0;
  std::optional<double> ceiling_z_m;
};

Result<Levels> levels_of(const VoxelRoom& room) {
  const Cloud& cloud = room.cloud_map();
  Columns filled(room);
  std::vector<std::vector<float>> slices;  // heights of level surfaces by layers
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector2i c = filled.of(cloud.points[i]);
    filled.at(c.x(), c.y()) = 1;
    if (std::abs(cloud.normals[i].z()) < kLevel) continue;
    const auto layer = static_cast<std::size_t>((cloud.points[i].z() - room.low_map().z()) / kVoxel_m);
    if (slices.size() <= layer) slices.resize(layer + 1);
    slices[layer].push_back(cloud.points[i].z());
  }
  const double enough = kShareOfRoom * enclosed(filled);
  std::vector<double> levels;
  for (std::size_t i = 0; i + 1 < slices.size(); ++i) {  // a level may straddle two layers
    std::vector<float> both = slices[i];
    both.insert(both.end(), slices[i + 1].begin(), slices[i + 1].end());
    if (static_cast<double>(both.size()) < enough) continue;
    std::ranges::nth_element(both, both.begin() + static_cast<std::ptrdiff_t>(both.size() / 2));
    levels.push_back(both[both.size() / 2]);
  }
  if (levels.empty())
    return fail("the scan shows no floor: no level covers a fifth of it; is z up, and the floor scanned?");
  Levels found{levels.front(), std::nullopt};
  if (levels.back() > levels.front() + kLeastHeight_m) found.ceiling_z_m = levels.back();
  return found;
}

/// Columns that a body can stand in: 1; others 0.
Columns free_columns(const VoxelRoom& room, double floor_z_m, const FloorOptions& options) {
  Columns free(room);
  const Cloud& cloud = room.cloud_map();
  for (const Vector3f& p : cloud.points)  // a scan's floor has gaps of a voxel
    if (std::abs(p.z() - floor_z_m) < options.step_m) free.stamp(p, 1.5 * kVoxel_m, 1);
  for (const Vector3f& p : cloud.points)
    if (p.z() > floor_z_m + options.step_m && p.z() < floor_z_m + options.head_m)
      free.stamp(p, options.body_radius_m, 0);
  return free;
}

/// Gives every part of the free columns a number from 2 on; their sizes in columns.
std::vector<std::size_t> number_parts(Columns& free) {
  std::vector<std::size_t> sizes;
  std::vector<Eigen::Vector2i> todo;
  for (int y = 0; y < free.height; ++y)
    for (int x = 0; x < free.width; ++x) {
      if (free.at(x, y) != 1) continue;
      const int number = static_cast<int>(sizes.size()) + 2;
      sizes.push_back(0);
      todo.emplace_back(x, y);
      free.at(x, y) = number;
      while (!todo.empty()) {
        const Eigen::Vector2i c = todo.back();
        todo.pop_back();
        ++sizes.back();
        for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
          if (free.has(c.x() + dx, c.y() + dy) && free.at(c.x() + dx, c.y() + dy) == 1) {
            free.at(c.x() + dx, c.y() + dy) = number;
            todo.emplace_back(c.x() + dx, c.y() + dy);
          }
      }
    }
  return sizes;
}

/// Keeps the large parts as 1; how many columns they have.
std::size_t keep_large_parts(Columns& free) {
  const std::vector<std::size_t> sizes = number_parts(free);
  const std::size_t largest = sizes.empty() ? 0 : *std::ranges::max_element(sizes);
  std::size_t kept = 0;
  for (int& cell : free.cells) {
    const std::size_t size = cell < 2 ? 0 : sizes[static_cast<std::size_t>(cell - 2)];
    cell = size > 0 && static_cast<double>(size) >= kShareOfLargest * static_cast<double>(largest) ? 1 : 0;
    kept += static_cast<std::size_t>(cell);
  }
  return kept;
}

}  // namespace

Result<FreeFloor> find_free_floor(const VoxelRoom& room, const FloorOptions& options) {
  const auto levels = levels_of(room);
  if (!levels) return tl::unexpected(levels.error());
  Columns free = free_columns(room, levels->floor_z_m, options);
  const std::size_t columns = keep_large_parts(free);
  if (columns == 0)
    return fail("nowhere in the scan is {:.1f} m of floor free to stand on; is z up, and the floor scanned?",
                2 * options.body_radius_m);
  FreeFloor found{
      levels->floor_z_m, levels->ceiling_z_m, static_cast<double>(columns) * kVoxel_m * kVoxel_m, 0, {}};
  const double even_m = std::sqrt(found.area_m2 / static_cast<double>(options.most_places));
  const int stride = std::max(1, static_cast<int>(std::ceil(std::max(kClosest_m, even_m) / kVoxel_m)));
  found.spacing_m = stride * kVoxel_m;
  for (int y = stride / 2; y < free.height; y += stride)
    for (int x = stride / 2; x < free.width; x += stride)
      if (free.at(x, y) == 1) found.places_map.push_back(free.middle(x, y));
  if (!found.places_map.empty()) return found;
  for (int y = 0; y < free.height && found.places_map.empty(); ++y)  // so little that the grid misses it
    for (int x = 0; x < free.width && found.places_map.empty(); ++x)
      if (free.at(x, y) == 1) found.places_map.push_back(free.middle(x, y));
  return found;
}

}  // namespace liloc::plan
