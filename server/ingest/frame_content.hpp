#pragma once
// What a ceiling frame shows of the room, as far as it tells a sound LiDAR from a blind one or a wrong unit.
#include "common/geometry/camera.hpp"
#include "common/geometry/cloud.hpp"

namespace liloc {

struct FrameContent {
  double returns = 0;  ///< share of the pixels that measured something, 0..1
  double usable = 0;   ///< share of those returns that registration would use (`DepthOptions`)
  double range_m = 0;  ///< median z-depth of the returns; 0 without any
  double far_m = 0;    ///< 95 % of them are nearer
};

[[nodiscard]] FrameContent content_of(const DepthImage& image, const Camera& camera);
/// Of a LiDAR that sends points: those before it, against the pixels of that camera.
[[nodiscard]] FrameContent content_of(const Cloud& cloud_sensor, const Camera& camera);

}  // namespace liloc
