#include "server/plan/sensor_rays.hpp"

#include <algorithm>
#include <cmath>

namespace liloc::plan {
namespace {

using Eigen::Vector3f;

constexpr float kGrazing = 0.1F;  // cosine below which returns are rare, as of a real L515; by hand

/// Unit directions of the middles of a grid over the image.
std::vector<Vector3f> directions(const Camera& camera, int columns, int rows) {
  std::vector<Vector3f> all;
  all.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const double u = (column + 0.5) * camera.width / columns - 0.5;
      const double v = (row + 0.5) * camera.height / rows - 0.5;
      all.push_back(Eigen::Vector3d((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1)
                        .normalized()
                        .cast<float>());
    }
  return all;
}

/// So many rays that neighbours are a voxel apart at the range, but no more than pixels.
int rays_along(int pixels, double focal, double range_m) {
  const double pixels_of_a_voxel = focal * kVoxel_m / range_m;
  return std::clamp(static_cast<int>(std::ceil(pixels / pixels_of_a_voxel)), 8, std::max(8, pixels));
}

}  // namespace

SensorRays::SensorRays(const Camera& camera, double range_m)
    : directions_(directions(camera, rays_along(camera.width, camera.fx, range_m),
                             rays_along(camera.height, camera.fy, range_m))),
      grid_(directions(camera, kGridColumns, kGridRows)),
      range_m_(static_cast<float>(range_m)) {}

std::vector<Surface> SensorRays::seen(const VoxelRoom& room, const Pose& T_map_sensor) const {
  const Eigen::Isometry3f T = T_map_sensor.cast<float>();
  const Vector3f from = T.translation();
  std::vector<Surface> surfaces;
  surfaces.reserve(directions_.size());
  for (const Vector3f& ray : directions_) {
    const Vector3f direction = T.linear() * ray;
    const auto hit = room.first_hit(from, direction, range_m_);
    if (hit && -room.normal_map(hit->surface).dot(direction) >= kGrazing) surfaces.push_back(hit->surface);
  }
  std::ranges::sort(surfaces);
  surfaces.erase(std::unique(surfaces.begin(), surfaces.end()), surfaces.end());
  surfaces.shrink_to_fit();  // thousands of views are kept
  return surfaces;
}

std::vector<float> SensorRays::ranges(const VoxelRoom& room, const Pose& T_map_sensor) const {
  const Eigen::Isometry3f T = T_map_sensor.cast<float>();
  std::vector<float> all;
  all.reserve(grid_.size());
  for (const Vector3f& ray : grid_) {
    const auto hit = room.first_hit(T.translation(), T.linear() * ray, range_m_);
    all.push_back(hit ? hit->distance_m : range_m_);
  }
  return all;
}

}  // namespace liloc::plan
