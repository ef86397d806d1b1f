#include "client/odometry/image_thinning.hpp"

#include <algorithm>

namespace liloc {

DepthImage thinned(const DepthImage& image, int factor) {
  DepthImage small;
  small.stamp_ns = image.stamp_ns;
  small.width = (image.width + factor - 1) / factor;
  small.height = (image.height + factor - 1) / factor;
  small.units.reserve(static_cast<std::size_t>(small.width) * static_cast<std::size_t>(small.height));
  for (int v = 0; v < image.height; v += factor)
    for (int u = 0; u < image.width; u += factor) {
      const std::uint16_t depth = image.at(u, v);
      small.units.push_back(is_return(depth) ? depth : std::uint16_t{0});
    }
  return small;
}

Camera thinned(const Camera& camera, int factor) {
  Camera small = camera;
  small.width = (camera.width + factor - 1) / factor;
  small.height = (camera.height + factor - 1) / factor;
  small.fx /= factor;
  small.fy /= factor;
  small.cx /= factor;
  small.cy /= factor;
  return small;
}

int thinning_for(const Camera& camera) {
  return std::max(1, camera.width / 320);
}

}  // namespace liloc
