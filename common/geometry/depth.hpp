#pragma once
#include <optional>

#include "common/geometry/camera.hpp"
#include "common/geometry/cloud.hpp"

namespace liloc {

/// Defaults are by hand where nothing else is said.
struct DepthOptions {
  double min_range_m = 0.25;  ///< z-depth; nearer returns are the sensor's own housing (L515: paper, Table 1)
  double max_range_m = 8.5;   ///< z-depth; farther returns of a 9 m sensor are mostly noise
  double flying_pixel_share = 0.05;  ///< a pixel farther than this share of its depth from both neighbours in a
                                     ///< row and both in a column hangs in the air and is dropped; 0 keeps all
};

/// Makes 0 of every value that is no return (see `is_return`): what readers of images do first.
void mark_missing(DepthImage& image);

/// Depth image to points in the sensor frame (paper, section 4.2), one per valid pixel, row by row.
/// Errors: the image's size differs from the camera's, or its data from its size.
[[nodiscard]] Result<Cloud> depth_to_cloud(const DepthImage& image, const Camera& camera,
                                           const DepthOptions& options = {});

/// The pixel {u, v} that a point in the sensor frame falls on; none outside the image, behind it, or if the
/// point is not finite.
[[nodiscard]] std::optional<Eigen::Vector2i> pixel_of(const Camera& camera, const Eigen::Vector3f& p_sensor);

/// What a camera at the sensor's place would measure of a cloud: the nearest point of each pixel. What cannot
/// be said in its units is left out.
[[nodiscard]] DepthImage cloud_to_depth(const Cloud& cloud_sensor, const Camera& camera, StampNs stamp_ns);

}  // namespace liloc
