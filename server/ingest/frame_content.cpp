#include "server/ingest/frame_content.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "common/base/quantile.hpp"
#include "common/geometry/depth.hpp"

namespace liloc {
namespace {

// One thread takes the frames of all LiDARs. Of over 20 000 pixels one in seven tells as much; by hand.
constexpr std::size_t kStep = 7, kEnough = 20'000;

/// From pixel to pixel: no factor of the width, or whole columns would be left out.
std::size_t step_of(const DepthImage& image) {
  if (image.units.size() <= kEnough) return 1;
  std::size_t step = kStep;
  while (std::gcd(step, static_cast<std::size_t>(std::max(1, image.width))) > 1) ++step;
  return step;
}

/// Of the returns: z-depths, and how far below the LiDAR they lie.
struct Returns {
  std::vector<float> depths_m, drops_m;
  void add(const Eigen::Vector3f& p_sensor, const Eigen::Vector3f& down_sensor) {
    depths_m.push_back(p_sensor.z());
    drops_m.push_back(down_sensor.dot(p_sensor));
  }
};

Eigen::Vector3f down_of(const Pose& T_map_sensor) {
  return -T_map_sensor.linear().row(2).transpose().cast<float>();
}

FrameContent content_of(const Returns& seen, std::size_t pixels) {
  FrameContent content;
  if (seen.depths_m.empty() || pixels == 0) return content;
  const DepthOptions used;
  const auto count = static_cast<double>(seen.depths_m.size());
  content.returns = std::min(1.0, count / static_cast<double>(pixels));
  content.usable =
      static_cast<double>(std::ranges::count_if(
          seen.depths_m, [&](float z) { return z >= used.min_range_m && z <= used.max_range_m; })) /
      count;
  content.range_m = static_cast<double>(median(seen.depths_m));
  content.far_m = static_cast<double>(quantile(seen.depths_m, 0.95));
  content.drop_m = static_cast<double>(quantile(seen.drops_m, 0.98));
  return content;
}

}  // namespace

FrameContent content_of(const DepthImage& image, const Camera& camera, const Pose& T_map_sensor) {
  Returns seen;
  const std::size_t step = step_of(image), width = static_cast<std::size_t>(std::max(1, image.width));
  const Eigen::Vector3f down = down_of(T_map_sensor);
  const auto cx = static_cast<float>(camera.cx), cy = static_cast<float>(camera.cy),
             fx = static_cast<float>(camera.fx), fy = static_cast<float>(camera.fy);
  for (std::size_t i = 0; i < image.units.size(); i += step) {
    if (!is_return(image.units[i])) continue;
    const auto z = static_cast<float>(image.units[i] * camera.depth_scale_m);
    const auto u = static_cast<float>(i % width), v = static_cast<float>(i / width);
    seen.add({(u - cx) / fx * z, (v - cy) / fy * z, z}, down);
  }
  return content_of(seen, (image.units.size() + step - 1) / step);
}

FrameContent content_of(const Cloud& cloud_sensor, const Camera& camera, const Pose& T_map_sensor) {
  Returns seen;
  const Eigen::Vector3f down = down_of(T_map_sensor);
  for (const Eigen::Vector3f& p : cloud_sensor.points)
    if (p.allFinite() && p.z() > 0) seen.add(p, down);
  return content_of(seen, static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height));
}

}  // namespace liloc
