#pragma once
#include "common/geometry/camera.hpp"

namespace liloc {

/// A depth image at 1/`factor` of the resolution by leaving pixels out (no averages across edges). What is no
/// return (`is_return`) becomes 0.
[[nodiscard]] DepthImage thinned(const DepthImage& image, int factor);
/// The camera of such an image.
[[nodiscard]] Camera thinned(const Camera& camera, int factor);
/// How far a camera's images may be thinned for the odometry: to 320 columns or a little more.
[[nodiscard]] int thinning_for(const Camera& camera);

}  // namespace liloc
