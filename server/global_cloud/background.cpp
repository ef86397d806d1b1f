#include "server/global_cloud/background.hpp"

#include <algorithm>

namespace liloc {

Background::Background(const Camera& camera, const BackgroundOptions& options)
    : options_(options),
      scale_m_(camera.depth_scale_m),
      pixels_(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height)) {}

bool Background::moving(Pixel* pixel, std::uint16_t units, float now_s) const {
  const int tolerance = static_cast<int>(options_.tolerance_m / scale_m_ + 0.01 * units);
  const int nearer = static_cast<int>(pixel->surface) - units;
  if (nearer <= tolerance) {  // the known surface, or one behind it that was hidden so far
    pixel->surface = nearer < -tolerance ? units : static_cast<std::uint16_t>((3 * pixel->surface + units) / 4);
    pixel->candidate = 0;
    return false;
  }
  if (pixel->candidate == 0 || std::abs(static_cast<int>(pixel->candidate) - units) > tolerance) {
    pixel->candidate = units;
    pixel->candidate_since_s = now_s;
  }
  if (now_s - pixel->candidate_since_s < static_cast<float>(options_.settle_seconds)) return true;
  pixel->surface = units;
  pixel->candidate = 0;
  return false;
}

DepthImage Background::without_moving(const DepthImage& image) {
  if (first_ns_ == 0) first_ns_ = image.stamp_ns;
  const auto now_s = static_cast<float>(to_seconds(image.stamp_ns - first_ns_));
  DepthImage still = image;
  const int width = image.width, height = image.height;
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    if (image.units[i] == 0) continue;
    if (pixels_[i].surface == 0) pixels_[i].surface = image.units[i];
    if (!moving(&pixels_[i], image.units[i], now_s)) continue;
    const int u = static_cast<int>(i) % width, v = static_cast<int>(i) / width;
    for (int y = std::max(0, v - 1); y <= std::min(height - 1, v + 1); ++y)
      for (int x = std::max(0, u - 1); x <= std::min(width - 1, u + 1); ++x)
        still.units[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x)] = 0;
  }
  return still;
}

}  // namespace liloc
