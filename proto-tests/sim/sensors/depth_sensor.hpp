#pragma once
// What a depth sensor makes of a view: noise, dropouts, flying pixels, whole units.
#include "common/geometry/camera.hpp"
#include "proto-tests/sim/base/options.hpp"
#include "proto-tests/sim/shapes/ray_caster.hpp"

namespace liloc::sim {

struct DepthSensor {
  Camera camera;
  double nearest_m = 0.2;  ///< along the ray
  double range_m = 9;      ///< along the ray
  double noise = 1;        ///< 0: exact
  SensorModel model = SensorModel::l515;
};

/// A hand in front of the sensor: an uneven, tilted surface 0.25 m away that covers most of the view.
void cover_by_hand(View& view, const Camera& camera, double time_s);

/// `key` decides all randomness of the frame.
[[nodiscard]] DepthImage sense(const View& view, const DepthSensor& sensor, std::uint64_t key,
                               StampNs stamp_ns);

}  // namespace liloc::sim
