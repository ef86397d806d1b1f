#pragma once
// What a ceiling frame shows of the room, as far as it tells a sound LiDAR from a blind one or a wrong unit.
#include "common/geometry/camera.hpp"
#include "common/geometry/cloud.hpp"
#include "common/geometry/pose.hpp"

namespace liloc {

struct FrameContent {
  double returns = 0;  ///< share of the pixels that measured something, 0..1
  double usable = 0;   ///< share of those returns that registration would use (`DepthOptions`)
  double range_m = 0;  ///< median z-depth of the returns; 0 without any
  double far_m = 0;    ///< 95 % of them are nearer
  double drop_m = 0;   ///< so far below the LiDAR, along the map's z, is what lies lowest: the floor
};

/// `T_map_sensor`: where the LiDAR hangs.
[[nodiscard]] FrameContent content_of(const DepthImage& image, const Camera& camera, const Pose& T_map_sensor);
/// Of a LiDAR that sends points: those before it, against the pixels of that camera.
[[nodiscard]] FrameContent content_of(const Cloud& cloud_sensor, const Camera& camera,
                                      const Pose& T_map_sensor);

}  // namespace liloc
