#include "client/src/points_view.hpp"

#include <cmath>
#include <cstdlib>

namespace liloc {
namespace {

constexpr double kOneSurface = 0.05;  // share of the depth by which neighbours on one surface may differ

/// The pixel that a point falls on; false outside the image or behind it.
bool project(const Eigen::Vector3f& point, const Camera& camera, int& u, int& v) {
  const Eigen::Vector3d p = point.cast<double>();
  if (!p.allFinite() || p.z() <= 1e-3) return false;
  const double x = camera.fx * p.x() / p.z() + camera.cx, y = camera.fy * p.y() / p.z() + camera.cy;
  if (!(x > -0.5 && x < camera.width - 0.5 && y > -0.5 && y < camera.height - 0.5)) return false;
  u = static_cast<int>(std::lround(x));
  v = static_cast<int>(std::lround(y));
  return u >= 0 && u < camera.width && v >= 0 && v < camera.height;
}

/// Between two returns of one surface their mean, otherwise nothing.
std::uint16_t between(std::uint16_t a, std::uint16_t b) {
  if (a == 0 || b == 0 || std::abs(a - b) > kOneSurface * a) return 0;
  return static_cast<std::uint16_t>((a + b) / 2);
}

void fill_holes(DepthImage& image) {
  const DepthImage seen = image;
  for (int v = 0; v < image.height; ++v)
    for (int u = 0; u < image.width; ++u) {
      if (seen.at(u, v) != 0) continue;
      std::uint16_t filled = 0;
      if (u > 0 && u + 1 < image.width) filled = between(seen.at(u - 1, v), seen.at(u + 1, v));
      if (filled == 0 && v > 0 && v + 1 < image.height) filled = between(seen.at(u, v - 1), seen.at(u, v + 1));
      image.units[static_cast<std::size_t>(v * image.width + u)] = filled;
    }
}

}  // namespace

DepthImage depth_of_points(const Cloud& cloud_sensor, const Camera& camera, StampNs stamp_ns) {
  DepthImage image{stamp_ns, camera.width, camera.height, {}};
  image.units.assign(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height), 0);
  for (const auto& point : cloud_sensor.points) {
    int u = 0, v = 0;
    if (!project(point, camera, u, v)) continue;
    const double units = static_cast<double>(point.z()) / camera.depth_scale_m;
    if (units < 1 || units > 65535) continue;
    auto& pixel = image.units[static_cast<std::size_t>(v * camera.width + u)];
    const auto depth = static_cast<std::uint16_t>(units);
    if (pixel == 0 || depth < pixel) pixel = depth;
  }
  fill_holes(image);
  return image;
}

Cloud within_view(const Cloud& cloud_sensor, const Camera& camera, double min_range_m, double max_range_m) {
  Cloud inside;
  for (const auto& point : cloud_sensor.points) {
    int u = 0, v = 0;
    if (project(point, camera, u, v) && point.z() >= min_range_m && point.z() <= max_range_m)
      inside.points.push_back(point);
  }
  return inside;
}

}  // namespace liloc
