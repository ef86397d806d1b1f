#include "proto-tests/sim/sensors/depth_sensor.hpp"

#include <algorithm>
#include <cmath>

#include "proto-tests/sim/base/random.hpp"
#include "proto-tests/sim/sensors/sensor_models.hpp"

namespace liloc::sim {
namespace {

// Fitted to L515-like recordings (with slant): 5 mm at 1.5 m, 8 mm at 3 m, 15 mm at 7 m.
constexpr float kNoiseFloor_m = 0.0025F, kNoisePerMetre = 0.0012F;
constexpr float kRandomLoss = 0.012F;  // of all pixels
constexpr float kGrazing = 0.12F;      // cosine below which returns get rare
constexpr float kEdge_m = 0.06F;       // a step in depth that splits the beam
constexpr float kFlyingShare = 0.25F;  // of the pixels at such a step
constexpr float kLostShare = 0.25F;    // and of those that see neither side

/// Two shares in [0, 1) and a near-normal number from one hash.
struct Draw {
  explicit Draw(std::uint64_t key) {
    const std::uint64_t a = mix(key), b = mix(a);
    loss = static_cast<float>(a >> 40) * 0x1.0p-24F;
    edge = static_cast<float>(a & 0xFFFFFF) * 0x1.0p-24F;
    const auto part = [&](int shift) { return static_cast<float>((b >> shift) & 0xFFFF); };
    normal =
        (part(0) + part(16) + part(32) + part(48) - 131070.0F) * (1.0F / 37837.0F);  // sum of four: sd 37837
  }
  float loss, edge, normal;
};

float chance_of_loss(Material material, float cosine, float range_share) {
  float loss = kRandomLoss;
  if (material == Material::glass) loss += 0.7F;
  if (material == Material::dark) loss += 0.04F;
  if (cosine < kGrazing) loss += 0.8F * (1 - cosine / kGrazing);
  if (range_share > 0.93F) loss += 4 * (range_share - 0.93F);  // fades over the last metre
  return loss;
}

/// One standard deviation along the ray.
float spread_m(Material material, float cosine, float range_m) {
  const float slant = std::min(2.0F, 1 / std::sqrt(std::max(cosine, 0.05F)));
  const float dim = material == Material::dark ? 1.5F : 1.0F;
  return dim * slant * (kNoiseFloor_m + kNoisePerMetre * range_m);
}

/// The depth of a pixel whose beam may also meet what is seen to the right or below: its own, a mix of both (a
/// flying pixel), or 0 where neither is strong enough.
float split_beam(const View& view, const Camera& camera, int u, int v, float edge_draw) {
  const bool right = edge_draw < 0.5F;
  const float share = 2 * edge_draw - (right ? 0.0F : 1.0F);
  const auto pixel = static_cast<std::size_t>(v * camera.width + u);
  const float depth = view.depth_m[pixel];
  if (right ? u + 1 >= camera.width : v + 1 >= camera.height) return depth;
  const float other = view.depth_m[right ? pixel + 1 : pixel + static_cast<std::size_t>(camera.width)];
  if (other <= 0 || std::abs(other - depth) < kEdge_m + 0.03F * depth) return depth;
  if (share > 1 - kLostShare) return 0;
  return share < kFlyingShare ? depth + (other - depth) * (share / kFlyingShare) : depth;
}

}  // namespace

void cover_by_hand(View& view, const Camera& camera, double time_s) {
  const double wobble = std::sin(5 * time_s), shift = 0.15 * std::sin(2.1 * time_s);
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const double x = 2.0 * u / camera.width - 1 - shift, y = 2.0 * v / camera.height - 1;
      if (x * x + 0.8 * y * y > 1.3) continue;
      const auto pixel = static_cast<std::size_t>(v * camera.width + u);
      view.depth_m[pixel] = static_cast<float>(0.25 + 0.03 * x + 0.02 * wobble * y);
      view.cos_incidence[pixel] = 0.9F;
      view.material[pixel] = Material::matte;
    }
}

namespace {

DepthImage sense_l515(const View& view, const DepthSensor& sensor, std::uint64_t key, StampNs stamp_ns) {
  const Camera& camera = sensor.camera;
  DepthImage image{stamp_ns, camera.width, camera.height, std::vector<std::uint16_t>(view.depth_m.size(), 0)};
  const auto unit = static_cast<float>(1.0 / camera.depth_scale_m), noise = static_cast<float>(sensor.noise);
  const auto nearest = static_cast<float>(sensor.nearest_m), range_limit = static_cast<float>(sensor.range_m);
  const std::uint64_t frame = mix(key);
  std::size_t pixel = 0;
  for (int v = 0; v < camera.height; ++v) {
    const auto y = static_cast<float>((v - camera.cy) / camera.fy);
    for (int u = 0; u < camera.width; ++u, ++pixel) {
      float depth = view.depth_m[pixel];
      const auto x = static_cast<float>((u - camera.cx) / camera.fx);
      const float ray = std::sqrt(x * x + y * y + 1), range = depth * ray;
      if (range < nearest || range > range_limit) continue;
      if (noise > 0) {
        const Draw draw(frame + pixel);
        const float cosine = view.cos_incidence[pixel];
        if (draw.loss < noise * chance_of_loss(view.material[pixel], cosine, range / range_limit)) continue;
        depth = split_beam(view, camera, u, v, draw.edge);
        if (depth <= 0) continue;
        depth += noise * draw.normal * spread_m(view.material[pixel], cosine, range) / ray;
      }
      image.units[pixel] = static_cast<std::uint16_t>(std::clamp(depth * unit + 0.5F, 0.0F, 65535.0F));
    }
  }
  return image;
}

}  // namespace

DepthImage sense(const View& view, const DepthSensor& sensor, std::uint64_t key, StampNs stamp_ns) {
  switch (sensor.model) {
    case SensorModel::l515_real:
      return sense_l515_real(view, sensor, key, stamp_ns);
    case SensorModel::kinect:
      return sense_kinect(view, sensor, key, stamp_ns);
    case SensorModel::tof:
      return sense_tof(view, sensor, key, stamp_ns);
    case SensorModel::l515:
      break;
  }
  return sense_l515(view, sensor, key, stamp_ns);
}

}  // namespace liloc::sim
