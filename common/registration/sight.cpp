#include "common/registration/sight.hpp"

#include <algorithm>
#include <cmath>

namespace liloc {

void SightView::prepare(const Camera& small) {
  width_ = small.width;
  height_ = small.height;
  width_f_ = static_cast<float>(width_);
  height_f_ = static_cast<float>(height_);
  fx_ = static_cast<float>(small.fx);
  fy_ = static_cast<float>(small.fy);
  cx_ = static_cast<float>(small.cx + 0.5);  // so that truncation picks the nearest pixel
  cy_ = static_cast<float>(small.cy + 0.5);
  bands_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), Band{});
}

SightView SightView::from_depth(const DepthImage& image, const Camera& camera, const Pose& T_sensor_world,
                                int factor, double max_range_m) {
  SightView view;
  view.prepare(shrunk(camera, factor));
  view.T_sensor_world_ = T_sensor_world.cast<float>();
  const auto scale = static_cast<float>(camera.depth_scale_m);
  const auto farthest = static_cast<float>(max_range_m);
  for (int v = 0; v < image.height; ++v) {
    Band* row = view.bands_.data() + static_cast<std::ptrdiff_t>(v / factor) * view.width_;
    for (int u = 0; u < image.width; ++u) {
      const std::uint16_t units = image.at(u, v);
      const float z = static_cast<float>(units) * scale;
      if (units == 0 || z > farthest) continue;
      Band& band = row[u / factor];
      band.near = band.far == 0 ? z : std::min(band.near, z);
      band.far = std::max(band.far, z);
    }
  }
  view.widen();
  return view;
}

SightView SightView::from_cloud(const Cloud& cloud_sensor, const Camera& camera, double voxel_size_m,
                                int width) {
  SightView view;
  view.prepare(shrunk(camera, std::max(1, (camera.width + width - 1) / width)));
  const auto half = static_cast<float>(0.6 * voxel_size_m);
  for (const Eigen::Vector3f& p : cloud_sensor.points) {
    if (p.z() < kNearest) continue;
    const float u = p.x() / p.z() * view.fx_ + view.cx_, v = p.y() / p.z() * view.fy_ + view.cy_;
    const float reach_u = half / p.z() * view.fx_, reach_v = half / p.z() * view.fy_;
    const int u0 = std::max(0, static_cast<int>(std::floor(u - reach_u)));
    const int u1 = std::min(view.width_ - 1, static_cast<int>(std::floor(u + reach_u)));
    const int v0 = std::max(0, static_cast<int>(std::floor(v - reach_v)));
    const int v1 = std::min(view.height_ - 1, static_cast<int>(std::floor(v + reach_v)));
    for (int y = v0; y <= v1; ++y)
      for (int x = u0; x <= u1; ++x) {
        Band& band = view.bands_[static_cast<std::size_t>(y) * static_cast<std::size_t>(view.width_) +
                                 static_cast<std::size_t>(x)];
        band.near = band.far == 0 ? p.z() : std::min(band.near, p.z());
        band.far = std::max(band.far, p.z());
      }
  }
  return view;
}

void SightView::widen() {
  const std::vector<Band> before = bands_;
  const auto merge = [](Band& band, const Band& other) {
    if (other.far == 0 || band.far == 0) return;
    band.near = std::min(band.near, other.near);
    band.far = std::max(band.far, other.far);
  };
  for (int v = 0; v < height_; ++v)
    for (int u = 0; u < width_; ++u) {
      const auto at = [&](int x, int y) -> std::size_t {
        return static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(x);
      };
      Band& band = bands_[at(u, v)];
      if (u > 0) merge(band, before[at(u - 1, v)]);
      if (u + 1 < width_) merge(band, before[at(u + 1, v)]);
      if (v > 0) merge(band, before[at(u, v - 1)]);
      if (v + 1 < height_) merge(band, before[at(u, v + 1)]);
    }
}

}  // namespace liloc
