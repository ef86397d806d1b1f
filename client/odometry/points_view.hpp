#pragma once
#include "common/geometry/camera.hpp"
#include "common/geometry/cloud.hpp"

namespace liloc {

/// What a camera at the sensor's place would measure of a cloud: the nearest point of each pixel; a pixel that
/// no point meets, between two neighbours of one surface, is filled in. No point, no return.
[[nodiscard]] DepthImage depth_of_points(const Cloud& cloud_sensor, const Camera& camera, StampNs stamp_ns);

/// The points within the camera's image and range, finite.
[[nodiscard]] Cloud within_view(const Cloud& cloud_sensor, const Camera& camera, double min_range_m,
                                double max_range_m);

}  // namespace liloc
