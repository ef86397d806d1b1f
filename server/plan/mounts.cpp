#include "server/plan/mounts.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace liloc::plan {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

// By hand, all of them.
constexpr double kStep_m = 0.8;       // of places along walls; twice that below open ceiling
constexpr double kByTheWall_m = 1.0;  // nearer, a LiDAR is moved to the wall
constexpr double kFreeView_m = 1.5;   // nearer, it would look at a wall
constexpr float kToCeiling_m = 1.0F;  // above a LiDAR, where the scan has a ceiling
constexpr int kAround = 8;            // rays that look for walls

struct Wall {
  double distance_m = 0, azimuth_rad = 0;
};

double level_range_m(const VoxelRoom& room, const Vector3d& at, double azimuth_rad, double range_m) {
  const Vector3f direction(static_cast<float>(std::cos(azimuth_rad)), static_cast<float>(std::sin(azimuth_rad)),
                           0);
  const auto hit = room.first_hit(at.cast<float>(), direction, static_cast<float>(range_m));
  return hit ? hit->distance_m : range_m;
}

Wall nearest_wall(const VoxelRoom& room, const Vector3d& at) {
  Wall nearest{2 * kByTheWall_m, 0};
  for (int i = 0; i < kAround; ++i) {
    const double azimuth_rad = 2 * std::numbers::pi * i / kAround;
    const double range_m = level_range_m(room, at, azimuth_rad, 2 * kByTheWall_m);
    if (range_m < nearest.distance_m) nearest = {range_m, azimuth_rad};
  }
  return nearest;
}

/// Where at this height LiDARs can hang.
std::vector<Vector3d> places(const VoxelRoom& room, const FreeFloor& floor, double z_m, double off_wall_m) {
  std::vector<Vector3d> all;
  const Vector3d low = room.low_map().cast<double>(), high = room.high_map().cast<double>();
  int row = 0;
  for (double y = low.y() + 0.5 * kStep_m; y < high.y(); y += kStep_m, ++row) {
    int column = 0;
    for (double x = low.x() + 0.5 * kStep_m; x < high.x(); x += kStep_m, ++column) {
      Vector3d at(x, y, z_m);
      if (!can_hang(room, floor, at, 0)) continue;
      const Wall wall = nearest_wall(room, at);
      if (wall.distance_m < kByTheWall_m)
        at += (wall.distance_m - off_wall_m) *
              Vector3d(std::cos(wall.azimuth_rad), std::sin(wall.azimuth_rad), 0);
      else if (row % 2 == 1 || column % 2 == 1)
        continue;
      if (can_hang(room, floor, at, 0.8 * off_wall_m)) all.push_back(at);
    }
  }
  return all;
}

}  // namespace

bool can_hang(const VoxelRoom& room, const FreeFloor& floor, const Vector3d& at_map, double off_wall_m) {
  const Vector3f at = at_map.cast<float>();
  if (room.occupied(at)) return false;
  const auto above_floor_m = static_cast<float>(at_map.z() - floor.floor_z_m);
  if (!room.first_hit(at, -Vector3f::UnitZ(), above_floor_m + 0.3F)) return false;
  if (floor.ceiling_z_m && !room.first_hit(at - 0.2F * Vector3f::UnitZ(), Vector3f::UnitZ(),
                                           static_cast<float>(*floor.ceiling_z_m - at_map.z()) + kToCeiling_m))
    return false;
  if (off_wall_m <= 0) return true;
  for (int i = 0; i < kAround; ++i)
    if (level_range_m(room, at_map, 2 * std::numbers::pi * i / kAround, off_wall_m) < off_wall_m) return false;
  return true;
}

std::vector<Mount> possible_mounts(const VoxelRoom& room, const FreeFloor& floor, const MountOptions& options) {
  std::vector<Mount> all;
  for (std::size_t i = 0; i < options.below_ceiling_m.size(); ++i) {
    const double z_m = options.ceiling_z_m - options.below_ceiling_m[i];
    if (i > 0 && z_m < floor.floor_z_m + options.lowest_m) continue;
    for (const Vector3d& at : places(room, floor, z_m, options.off_wall_m))
      for (int k = 0; k < options.azimuths; ++k) {
        const double azimuth_rad = 2 * std::numbers::pi * k / options.azimuths;
        if (level_range_m(room, at, azimuth_rad, kFreeView_m) < kFreeView_m) continue;
        for (const double down_deg : options.down_deg) all.push_back({at, azimuth_rad, radians(down_deg)});
      }
  }
  std::mt19937_64 rng(options.seed);
  for (std::size_t i = all.size(); i > 1; --i)
    std::swap(all[i - 1], all[rng() % i]);  // std's differs by library
  if (all.size() > options.most) all.resize(options.most);
  return all;
}

}  // namespace liloc::plan
