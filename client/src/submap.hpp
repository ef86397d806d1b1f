#pragma once
#include "common/geometry/cloud.hpp"
#include "common/protocol/spot.hpp"

namespace liloc {

/// What a map of the surroundings holds outside a view, in the sensor frame and within its range: evenly
/// thinned to `most_points`. Inside the view the frame itself is the better and newer witness.
[[nodiscard]] Cloud outside_view(const Cloud& map_odom, const Pose& T_odom_sensor, const SensorView& view,
                                 std::size_t most_points);

}  // namespace liloc
