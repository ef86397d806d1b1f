#include <algorithm>
#include <cmath>

#include "proto-tests/sim/sensors/sensor_field.hpp"
#include "proto-tests/sim/sensors/sensor_models.hpp"

namespace liloc::sim {
namespace {

// After the Azure Kinect; no recording of one is here. Range: data sheet, narrow field, binned, 5.46 m. Random
// error: at most 17 mm (data sheet); published measurements of walls have 1 mm near 1 m and 3 to 5 mm at 5 m.
constexpr float kNearest_m = 0.25F, kFarthest_m = 5.46F;
constexpr float kNoiseFloor_m = 0.001F, kNoise_per_m = 0.00015F;  // the second with the square of the range
constexpr float kDarkNoise = 3.0F, kMostNoise_m = 0.017F;
constexpr double kGrain_rad = 0.003;  // a binned pixel's neighbours are filtered together
// Bounced light lengthens the way near concave corners: published bulges are 1 to 4 cm. A tenth of how far the
// corner lies behind the chord over 0.5 m gives 2.5 cm in a right angle, over half a metre's width.
constexpr float kHalfChord_m = 0.25F, kBulgeShare = 0.1F, kMostBehind_m = 0.3F;
// Mixed pixels, by hand: most are told invalid by the sensor itself, the rest lie anywhere between.
constexpr float kEdge_m = 0.08F, kFlyingShare = 0.3F, kInvalidShare = 0.4F;
// Share of returns: signal by the square of the range, the cosine and how bright; by hand so that a white wall
// is whole up to the range's end, and dark things (8 %) are half lost at 2.8 m.
constexpr float kLogitAt3m = 7.0F, kPerLogSignal = 3.0F, kDark = 0.08F, kCarpet = 0.4F, kGlass = 0.02F;

bool in_hexagon(float across, float down) {
  return std::abs(across) + 0.5F * std::abs(down) <= 1;
}

float brightness(Material material) {
  switch (material) {
    case Material::dark:
      return kDark;
    case Material::carpet:
      return kCarpet;
    case Material::glass:
      return kGlass;
    case Material::matte:
      break;
  }
  return 1;
}

/// How far the pixel lies behind the chord between its neighbours at half a chord's distance on one line.
float behind_chord_m(const View& view, const Camera& camera, int u, int v, bool along_u) {
  const auto pixel = [&](int du, int dv) {
    return view.depth_m[static_cast<std::size_t>((v + dv) * camera.width + u + du)];
  };
  const float depth = pixel(0, 0);
  const int reach = static_cast<int>(std::lround((along_u ? camera.fx : camera.fy) * kHalfChord_m / depth));
  const int at = along_u ? u : v, end = along_u ? camera.width : camera.height;
  if (reach < 1 || at < reach || at + reach >= end) return 0;
  const float a = along_u ? pixel(-reach, 0) : pixel(0, -reach),
              b = along_u ? pixel(reach, 0) : pixel(0, reach);
  if (a <= 0 || b <= 0) return 0;
  const float chord = 2 / (1 / a + 1 / b);  // a plane is even in inverse depth
  const float behind = depth - chord;
  return behind > 0 && behind < kMostBehind_m && std::abs(a - b) < 2 * kHalfChord_m + kMostBehind_m ? behind
                                                                                                    : 0;
}

/// As the beam mixes what the pixel and its neighbours to the right and below see; 0: invalid.
float mixed(const View& view, const Camera& camera, int u, int v, std::uint64_t draw) {
  const float depth = view.depth_m[static_cast<std::size_t>(v * camera.width + u)];
  const bool right = (draw & 1) != 0;
  if (right ? u + 1 >= camera.width : v + 1 >= camera.height) return depth;
  const float other =
      view.depth_m[static_cast<std::size_t>(right ? v * camera.width + u + 1 : (v + 1) * camera.width + u)];
  if (other <= 0 || std::abs(other - depth) < kEdge_m + 0.02F * depth) return depth;
  const float share = static_cast<float>(draw >> 40) * 0x1.0p-24F;
  if (share > 1 - kInvalidShare) return 0;
  return share < kFlyingShare ? depth + (other - depth) * share / kFlyingShare : depth;
}

}  // namespace

DepthImage sense_tof(const View& view, const DepthSensor& sensor, std::uint64_t key, StampNs stamp_ns) {
  const Camera& camera = sensor.camera;
  DepthImage image{stamp_ns, camera.width, camera.height, std::vector<std::uint16_t>(view.depth_m.size(), 0)};
  const std::uint64_t frame = mix(key);
  const SensorField depths(mix(frame + 1), kGrain_rad * camera.fx),
      losses(mix(frame + 2), kGrain_rad * camera.fx);
  const auto noise = static_cast<float>(sensor.noise);
  const float nearest = std::max(kNearest_m, static_cast<float>(sensor.nearest_m));
  const float farthest = std::min(kFarthest_m, static_cast<float>(sensor.range_m));
  std::size_t pixel = 0;
  for (int v = 0; v < camera.height; ++v) {
    const auto y = static_cast<float>((v - camera.cy) / camera.fy);
    for (int u = 0; u < camera.width; ++u, ++pixel) {
      float depth = view.depth_m[pixel];
      const auto x = static_cast<float>((u - camera.cx) / camera.fx);
      const float ray = std::sqrt(x * x + y * y + 1), range = depth * ray;
      if (range < nearest || range > farthest) continue;
      const float across = 2 * static_cast<float>(u) / static_cast<float>(camera.width) - 1;
      if (!in_hexagon(across, 2 * static_cast<float>(v) / static_cast<float>(camera.height) - 1)) continue;
      if (noise > 0) {
        const float bright = brightness(view.material[pixel]),
                    cosine = std::max(view.cos_incidence[pixel], 0.02F);
        const float logit = kLogitAt3m + kPerLogSignal * std::log(bright * cosine * 9 / (range * range));
        if (share_below(losses.at(u, v)) > 1 - noise * (1 - logistic(logit))) continue;
        const float bulge_m = kBulgeShare * std::max(behind_chord_m(view, camera, u, v, true),
                                                     behind_chord_m(view, camera, u, v, false));
        depth = mixed(view, camera, u, v, mix(frame + 3 + pixel));
        if (depth <= 0) continue;
        const float dim = bright < 0.5F ? kDarkNoise : 1 / std::sqrt(std::max(cosine, 0.1F));
        const float spread_m = std::min(kMostNoise_m, dim * (kNoiseFloor_m + kNoise_per_m * range * range));
        depth += noise * (bulge_m + spread_m * depths.at(u, v)) / ray;
      }
      image.units[pixel] = in_units(depth, camera);
    }
  }
  return image;
}

}  // namespace liloc::sim
