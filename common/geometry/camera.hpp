#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "common/base/result.hpp"
#include "common/base/stamp.hpp"
#include "common/geometry/pose.hpp"

namespace liloc {

constexpr int kLargestSide = 8192;  ///< of an image, in pixels: no depth camera has as many; by hand

/// Pinhole intrinsics of a depth sensor, in pixels; optical frame: x right, y down, z forward.
struct Camera {
  int width = 0, height = 0;
  double fx = 0, fy = 0, cx = 0, cy = 0;
  double depth_scale_m = 0.001;  ///< metres per unit of a depth image

  /// Checks sizes 1..8192, focal lengths by the angles of view (1..170 deg), centre within one image size of
  /// the image, scale 1e-5..0.1 m.
  [[nodiscard]] Result<Camera> validated(std::string_view what) const;
};

/// The same view at 1/`factor` of the resolution (rounded up).
[[nodiscard]] Camera shrunk(const Camera& camera, int factor);

/// Whether a depth value is a measurement: 0 is none, and drivers that mark a missing return by the largest
/// value do so whatever the scale, so 65535 is none either.
[[nodiscard]] constexpr bool is_return(std::uint16_t units) {
  return units != 0 && units != 65535;
}

/// 16-bit z-depth, row-major; 0 = no return. Whoever reads images from outside marks what is none
/// (`mark_missing`).
struct DepthImage {
  StampNs stamp_ns = 0;
  int width = 0, height = 0;
  std::vector<std::uint16_t> units;

  [[nodiscard]] std::uint16_t at(int u, int v) const {
    return units[static_cast<std::size_t>(v) * static_cast<std::size_t>(width) + static_cast<std::size_t>(u)];
  }
};

/// A ceiling LiDAR of a site.
struct GlobalLidar {
  std::string id;
  Camera camera;
  double rate_hz = 0;
  Pose T_map_sensor = Pose::Identity();
};

/// What the server knows of the place it serves.
struct Site {
  std::string world_frame = "map";
  std::vector<GlobalLidar> global_lidars;
};

/// One inertial sample in the IMU's axes; specific force: a device at rest reads +g upwards.
struct ImuSample {
  StampNs stamp_ns = 0;
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d specific_force_m_s2 = Eigen::Vector3d::Zero();
};

}  // namespace liloc
