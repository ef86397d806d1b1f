#include <algorithm>
#include <cmath>
#include <limits>

#include "proto-tests/sim/sensors/sensor_field.hpp"
#include "proto-tests/sim/sensors/sensor_models.hpp"

namespace liloc::sim {
namespace {

// Fitted to recordings/kitchen-real (a Kinect) and classroom-real (an Xtion), see SENSORS.md. Depth comes in
// steps of 2.85 mm at 1 m, rising with the square: whole steps of disparity.
constexpr float kStep_per_m = 2.85e-3F;
// Residuals to the line through pixels 8 to the left and right: 1.9e-3 z^2 in both, of which the steps are
// 0.8e-3.
constexpr float kNoise_per_m = 1.65e-3F;
constexpr double kGrain_rad = 0.008;       // half the matching window: 9 of 570 pixels per radian
constexpr double kProjector_m = 0.075;     // to the right of the camera: the Kinect's published baseline
constexpr float kOutline_px_rad = 0.003F;  // frayed outlines: about two of 570 pixels per radian
constexpr float kNearest_m = 0.5F, kFarthest_m = 8.0F;  // the least and greatest depth in both recordings
// Share of pixels with depth: 0.89 in the kitchen, within 3 m, and 0.77 in the classroom, up to 8 m, most of
// what is lost being dark, shiny or grazed. Logit by hand so that simulated offices lose as much.
constexpr float kLogitAt2m = 5.5F, kPerLogRange = -1.6F, kPerLogCosine = 1.5F, kDarkLogit = -4.0F;
constexpr float kGlassLogit = -8.0F;  // by hand: nothing comes back
constexpr double kHole_rad = 0.02;    // holes are blobs of about ten pixels of 570 per radian

/// Where the projector's light does not reach, right to left: a nearer thing further right stands before it.
void mark_shadow(const View& view, const Camera& camera, int v, std::vector<bool>& shadow) {
  double covered_from = std::numeric_limits<double>::max();
  for (int u = camera.width - 1; u >= 0; --u) {
    const float depth = view.depth_m[static_cast<std::size_t>(v * camera.width + u)];
    if (depth <= 0) continue;
    const double seen_at = u - camera.fx * kProjector_m / depth;  // by the projector
    shadow[static_cast<std::size_t>(u)] = seen_at > covered_from;
    covered_from = std::min(covered_from, seen_at);
  }
}

float chance_of_depth(float depth_m, float cosine, Material material) {
  float logit =
      kLogitAt2m + kPerLogRange * std::log(depth_m / 2) + kPerLogCosine * std::log(std::max(cosine, 0.03F));
  if (material == Material::dark) logit += kDarkLogit;
  if (material == Material::glass) logit += kGlassLogit;
  return logistic(logit);
}

}  // namespace

DepthImage sense_kinect(const View& view, const DepthSensor& sensor, std::uint64_t key, StampNs stamp_ns) {
  const Camera& camera = sensor.camera;
  DepthImage image{stamp_ns, camera.width, camera.height, std::vector<std::uint16_t>(view.depth_m.size(), 0)};
  const std::uint64_t frame = mix(key);
  const auto field = [&](std::uint64_t stream, double grain_rad) {
    return SensorField(mix(frame + stream), grain_rad * camera.fx);
  };
  const SensorField depths = field(1, kGrain_rad), holes = field(2, kHole_rad), across = field(3, kGrain_rad),
                    down = field(4, kGrain_rad);
  const auto noise = static_cast<float>(sensor.noise);
  const float fray_px = noise * kOutline_px_rad * static_cast<float>(camera.fx);
  const float nearest = std::max(kNearest_m, static_cast<float>(sensor.nearest_m));
  const float farthest = std::min(kFarthest_m, static_cast<float>(sensor.range_m));
  std::vector<bool> shadow(static_cast<std::size_t>(camera.width));
  for (int v = 0; v < camera.height; ++v) {
    if (noise > 0) mark_shadow(view, camera, v, shadow);
    for (int u = 0; u < camera.width; ++u) {
      if (shadow[static_cast<std::size_t>(u)]) continue;
      const int from_u =
          std::clamp(u + static_cast<int>(std::lround(fray_px * across.at(u, v))), 0, camera.width - 1);
      const int from_v =
          std::clamp(v + static_cast<int>(std::lround(fray_px * down.at(u, v))), 0, camera.height - 1);
      const auto at = static_cast<std::size_t>(v * camera.width + u);
      const auto from = static_cast<std::size_t>(from_v * camera.width + from_u);
      const bool edge =
          std::abs(view.depth_m[from] - view.depth_m[at]) > 0.1F;  // else the ray's own depth is meant
      const std::size_t pixel = edge ? from : at;
      float depth = view.depth_m[pixel];
      if (depth < nearest || depth > farthest) continue;
      if (noise > 0) {
        const float kept = chance_of_depth(depth, view.cos_incidence[pixel], view.material[pixel]);
        if (share_below(holes.at(u, v)) > 1 - noise * (1 - kept)) continue;
        const float steps = (1 / depth + noise * kNoise_per_m * depths.at(u, v)) / kStep_per_m;
        depth = 1 / (kStep_per_m * std::max(1.0F, std::round(steps)));
      }
      image.units[at] = in_units(depth, camera);
    }
  }
  return image;
}

}  // namespace liloc::sim
