#pragma once
// A furnished room made of boxes, and what a depth sensor or an IMU in it would see: enough of a world for laws
// about registration and odometry, in milliseconds.
#include <cstdint>
#include <functional>
#include <vector>

#include "common/geometry/camera.hpp"

namespace liloc::scene {

struct Box {
  Eigen::Vector3d low, high;
};

/// z up, floor at 0; seen from inside.
struct BoxRoom {
  Box walls{{0, 0, 0}, {6, 5, 2.7}};
  std::vector<Box> furniture;
};

/// Nine boxes of furniture, placed by the seed; the middle of the room stays free.
[[nodiscard]] BoxRoom furnished_room(unsigned seed);

/// A bare corridor 40 m long: nothing shows motion along x.
[[nodiscard]] BoxRoom corridor();

/// 160 x 120 pixels, 70 degrees wide, millimetres.
[[nodiscard]] Camera small_camera();

/// Looks level from `position` towards `yaw_rad` (0: along x), pitched down by `down_rad`.
[[nodiscard]] Pose looking(const Eigen::Vector3d& position, double yaw_rad, double down_rad = 0);

/// What the sensor sees; Gaussian noise of `noise_m`, drawn from the seed and the stamp.
[[nodiscard]] DepthImage render(const BoxRoom& room, const Pose& T_map_sensor, const Camera& camera,
                                StampNs stamp_ns, double noise_m = 0, unsigned seed = 1);

/// IMU samples at `rate_hz` of a sensor that moves as `T_map_sensor` says (of time in seconds), by differences.
[[nodiscard]] std::vector<ImuSample> imu_along(const std::function<Pose(double)>& T_map_sensor,
                                               const Pose& T_imu_sensor, double from_s, double to_s,
                                               double rate_hz, StampNs start_ns);

}  // namespace liloc::scene
