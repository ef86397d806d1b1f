#include <algorithm>
#include <cmath>

#include "proto-tests/sim/sensors/sensor_field.hpp"
#include "proto-tests/sim/sensors/sensor_models.hpp"

namespace liloc::sim {
namespace {

// All fitted to recordings/lab-l515, two L515 that stand still for 45 frames each (SENSORS.md). Logit of the
// share of frames in which a pixel has a return: logistic regression over 330 000 pixels.
constexpr float kLogitAt3m = 3.05F, kPerLogRange = -3.85F, kPerFieldSquare = -4.88F, kPerLogCosine = 2.8F;
constexpr float kDarkLogit = -3.3F;   // dark doors and the carpet there against the walls, 2 to 5 m away
constexpr float kGlassLogit = -5.0F;  // by hand: the recording has no glass; nothing comes back either way
constexpr float kSteepest = 0.03F;    // cosine below which the regression has no pixels
// Noise along the ray by the same logit: 5 mm where every frame has a return, 16 mm where one in four has.
constexpr float kNoiseAtHalf_m = 0.0138F, kNoisePerLogit_m = -0.0022F;
constexpr float kLeastNoise_m = 0.0045F, kMostNoise_m = 0.018F;  // about the ends of the fit
// Neighbours share their noise (0.72 at one of 640 pixels, 0.26 at four) and their losses (0.51 and 0.14).
constexpr double kGrain_rad = 0.0066;
// At the outline of a board 3 m away, 1.7 m before a wall: 0.2 to 0.3 fewer returns within a pixel of 320,
// 2 % of all depths in between beside one sensor, none beside the other.
constexpr float kEdgeShare = 0.02F, kEdgeLoss = 0.25F, kFlyingShare = 0.01F;

float logit_of(float depth_m, float field_square, float cosine, Material material) {
  float logit = kLogitAt3m + kPerLogRange * std::log(depth_m / 3) + kPerFieldSquare * field_square +
                kPerLogCosine * std::log(std::max(cosine, kSteepest));
  if (material == Material::dark || material == Material::carpet) logit += kDarkLogit;
  if (material == Material::glass) logit += kGlassLogit;
  return logit;
}

/// The depth of the farthest-off neighbour, where one lies on another surface; else the pixel's own.
float across_edge(const View& view, const Camera& camera, int u, int v) {
  const auto pixel = static_cast<std::size_t>(v * camera.width + u);
  const float depth = view.depth_m[pixel];
  float other = depth;
  for (const auto& [du, dv] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
    if (u + du < 0 || v + dv < 0 || u + du >= camera.width || v + dv >= camera.height) continue;
    const float near = view.depth_m[static_cast<std::size_t>((v + dv) * camera.width + u + du)];
    if (near > 0 && std::abs(near - depth) > std::abs(other - depth)) other = near;
  }
  return std::abs(other - depth) > 0.06F + kEdgeShare * depth ? other : depth;
}

}  // namespace

DepthImage sense_l515_real(const View& view, const DepthSensor& sensor, std::uint64_t key, StampNs stamp_ns) {
  const Camera& camera = sensor.camera;
  DepthImage image{stamp_ns, camera.width, camera.height, std::vector<std::uint16_t>(view.depth_m.size(), 0)};
  const std::uint64_t frame = mix(key);
  const SensorField losses(mix(frame + 1), kGrain_rad * camera.fx),
      depths(mix(frame + 2), kGrain_rad * camera.fx);
  const auto noise = static_cast<float>(sensor.noise);
  std::size_t pixel = 0;
  for (int v = 0; v < camera.height; ++v) {
    const auto y = static_cast<float>((v - camera.cy) / camera.fy);
    for (int u = 0; u < camera.width; ++u, ++pixel) {
      float depth = view.depth_m[pixel];
      const auto x = static_cast<float>((u - camera.cx) / camera.fx);
      const float ray = std::sqrt(x * x + y * y + 1);
      if (depth * ray < static_cast<float>(sensor.nearest_m) ||
          depth * ray > static_cast<float>(sensor.range_m))
        continue;
      if (noise > 0) {
        const float logit = logit_of(depth, x * x + y * y, view.cos_incidence[pixel], view.material[pixel]);
        const float other = across_edge(view, camera, u, v);
        const float kept = logistic(logit) - (other == depth ? 0.0F : kEdgeLoss);
        const float draw = share_below(losses.at(u, v));
        if (draw > 1 - noise * (1 - kept)) continue;
        const std::uint64_t own = mix(frame + 3 + pixel);
        if (other != depth && static_cast<float>(own >> 40) * 0x1.0p-24F < kFlyingShare)
          depth += (other - depth) * static_cast<float>(own & 0xFFFFFF) * 0x1.0p-24F;
        const float spread_m =
            std::clamp(kNoiseAtHalf_m + kNoisePerLogit_m * logit, kLeastNoise_m, kMostNoise_m);
        depth += noise * spread_m * depths.at(u, v) / ray;
      }
      image.units[pixel] = in_units(depth, camera);
    }
  }
  return image;
}

}  // namespace liloc::sim
