#pragma once
#include <array>

#include "common/geometry/camera.hpp"

namespace liloc {

/// What sensor_msgs/msg/CameraInfo says of an image, wherever the message comes from.
struct CameraInfo {
  struct Region {
    std::uint32_t x_offset = 0, y_offset = 0, height = 0, width = 0;
  };
  std::uint32_t height = 0, width = 0;  ///< of the whole image, in pixels of the sensor
  std::array<double, 9> k{};            ///< of the raw image
  std::array<double, 12> p{};           ///< of the rectified image; 0: it was never anything else
  std::uint32_t binning_x = 0, binning_y = 0;
  Region roi;
};

/// Of the image that is sent: of the rectified one (p) where that is set, of its roi and binned, as
/// image_geometry has it. The depth scale stays at its default. Errors: not calibrated, a roi beyond the image,
/// intrinsics of no depth sensor; the message begins with "camera_info", "k" or "p".
[[nodiscard]] Result<Camera> camera_of(const CameraInfo& info);

}  // namespace liloc
