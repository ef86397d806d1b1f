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

FrameContent content_of(const std::vector<float>& depths_m, std::size_t pixels) {
  FrameContent content;
  if (depths_m.empty() || pixels == 0) return content;
  const DepthOptions used;
  const auto count = static_cast<double>(depths_m.size());
  content.returns = std::min(1.0, count / static_cast<double>(pixels));
  content.usable = static_cast<double>(std::ranges::count_if(
                       depths_m, [&](float z) { return z >= used.min_range_m && z <= used.max_range_m; })) /
                   count;
  content.range_m = static_cast<double>(median(depths_m));
  content.far_m = static_cast<double>(quantile(depths_m, 0.95));
  return content;
}

}  // namespace

FrameContent content_of(const DepthImage& image, const Camera& camera) {
  std::vector<float> depths_m;
  const std::size_t step = step_of(image);
  depths_m.reserve(image.units.size() / step + 1);
  for (std::size_t i = 0; i < image.units.size(); i += step)
    if (is_return(image.units[i]))
      depths_m.push_back(static_cast<float>(image.units[i] * camera.depth_scale_m));
  return content_of(depths_m, (image.units.size() + step - 1) / step);
}

FrameContent content_of(const Cloud& cloud_sensor, const Camera& camera) {
  std::vector<float> depths_m;
  for (const Eigen::Vector3f& p : cloud_sensor.points)
    if (p.allFinite() && p.z() > 0) depths_m.push_back(p.z());
  return content_of(depths_m, static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height));
}

}  // namespace liloc
