#include "client/odometry/points_view.hpp"

#include <cstdlib>

#include "common/geometry/depth.hpp"

namespace liloc {
namespace {

// Share of the depth by which neighbours on one surface may differ; by hand.
constexpr double kOneSurface = 0.05;

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
  DepthImage image = cloud_to_depth(cloud_sensor, camera, stamp_ns);
  fill_holes(image);
  return image;
}

Cloud within_view(const Cloud& cloud_sensor, const Camera& camera, double min_range_m, double max_range_m) {
  Cloud inside;
  for (const auto& point : cloud_sensor.points)
    if (pixel_of(camera, point) && point.z() >= min_range_m && point.z() <= max_range_m)
      inside.points.push_back(point);
  return inside;
}

}  // namespace liloc
