#include "common/geometry/depth.hpp"

#include <cmath>
#include <cstdlib>

namespace liloc {
namespace {

constexpr double kNearest_m = 1e-3;  // of what a camera may see

/// True when no neighbour along `step` supports the pixel; `lo`/`hi` say whether that neighbour exists.
bool unsupported(const std::uint16_t* pixel, std::ptrdiff_t step, bool lo, bool hi, int tolerance) {
  const int depth = *pixel;
  const auto near = [&](bool exists, std::ptrdiff_t offset) {
    return exists && is_return(pixel[offset]) && std::abs(static_cast<int>(pixel[offset]) - depth) <= tolerance;
  };
  return !near(lo, -step) && !near(hi, step);
}

}  // namespace

void mark_missing(DepthImage& image) {
  for (std::uint16_t& units : image.units) units = is_return(units) ? units : std::uint16_t{0};
}

Result<Cloud> depth_to_cloud(const DepthImage& image, const Camera& camera, const DepthOptions& options) {
  if (image.width != camera.width || image.height != camera.height)
    return fail("depth image is {}x{}, its intrinsics are for {}x{}", image.width, image.height, camera.width,
                camera.height);
  const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  if (image.units.size() != width * height)
    return fail("depth image has {} values, {}x{} needs {}", image.units.size(), width, height, width * height);

  Cloud cloud;
  cloud.points.reserve(width * height);
  std::vector<float> ray_x(width);
  for (std::size_t u = 0; u < width; ++u)
    ray_x[u] = static_cast<float>((static_cast<double>(u) - camera.cx) / camera.fx);
  const auto scale = static_cast<float>(camera.depth_scale_m);
  const auto nearest = static_cast<float>(options.min_range_m),
             farthest = static_cast<float>(options.max_range_m);
  for (std::size_t v = 0; v < height; ++v) {
    const auto ray_y = static_cast<float>((static_cast<double>(v) - camera.cy) / camera.fy);
    const std::uint16_t* row = image.units.data() + v * width;
    for (std::size_t u = 0; u < width; ++u) {
      const float z = static_cast<float>(row[u]) * scale;
      if (!is_return(row[u]) || z < nearest || z > farthest) continue;
      if (options.flying_pixel_share > 0) {
        const int tolerance = static_cast<int>(row[u] * options.flying_pixel_share);
        if (unsupported(row + u, 1, u > 0, u + 1 < width, tolerance) &&
            unsupported(row + u, static_cast<std::ptrdiff_t>(width), v > 0, v + 1 < height, tolerance))
          continue;
      }
      cloud.points.emplace_back(ray_x[u] * z, ray_y * z, z);
    }
  }
  return cloud;
}

std::optional<Eigen::Vector2i> pixel_of(const Camera& camera, const Eigen::Vector3f& p_sensor) {
  const Eigen::Vector3d p = p_sensor.cast<double>();
  if (!p.allFinite() || p.z() <= kNearest_m) return std::nullopt;
  const double u = camera.fx * p.x() / p.z() + camera.cx + 0.5, v = camera.fy * p.y() / p.z() + camera.cy + 0.5;
  if (!(u >= 0 && v >= 0 && u < camera.width && v < camera.height)) return std::nullopt;
  return Eigen::Vector2i(static_cast<int>(u), static_cast<int>(v));
}

DepthImage cloud_to_depth(const Cloud& cloud_sensor, const Camera& camera, StampNs stamp_ns) {
  const auto width = static_cast<std::size_t>(camera.width), height = static_cast<std::size_t>(camera.height);
  DepthImage image{stamp_ns, camera.width, camera.height, std::vector<std::uint16_t>(width * height, 0)};
  for (const Eigen::Vector3f& p : cloud_sensor.points) {
    const auto pixel = pixel_of(camera, p);
    if (!pixel) continue;
    const double units = static_cast<double>(p.z()) / camera.depth_scale_m + 0.5;
    if (units < 1 || units >= 65535) continue;
    std::uint16_t& held =
        image.units[static_cast<std::size_t>(pixel->y()) * width + static_cast<std::size_t>(pixel->x())];
    if (held == 0 || units < held) held = static_cast<std::uint16_t>(units);
  }
  return image;
}

}  // namespace liloc
