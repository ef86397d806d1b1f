#pragma once
// The ceiling LiDARs and the devices' sensors.
#include "common/recording/recording.hpp"
#include "proto-tests/sim/options.hpp"

namespace liloc::sim {

/// LiDARs in corners and at wall middles under the ceiling, about 30 degrees below the horizon, towards the
/// middle.
[[nodiscard]] Site make_site(const SimOptions& options, const Eigen::Vector3d& size_m);
[[nodiscard]] std::vector<DeviceInfo> make_devices(const SimOptions& options);

}  // namespace liloc::sim
