#pragma once
// The ceiling LiDARs and the devices' sensors.
#include "common/recording/recording.hpp"
#include "proto-tests/sim/base/options.hpp"

namespace liloc::sim {

/// World 1: LiDARs in corners and at wall middles under the ceiling, about 30 degrees below the horizon,
/// towards the middle.
[[nodiscard]] Site make_site(const SimOptions& options, const Eigen::Vector3d& size_m);
[[nodiscard]] std::vector<DeviceInfo> make_devices(const SimOptions& options);

/// A sensor at `from` that looks along an azimuth, so far below the horizon, rolled about its axis.
[[nodiscard]] Pose looking(const Eigen::Vector3d& from, double azimuth_rad, double down_rad, double roll_rad);

}  // namespace liloc::sim
