#pragma once
#include "common/geometry/cloud.hpp"
#include "common/protocol/spot.hpp"

namespace liloc {

/// What a map of the surroundings holds outside a view, in the sensor frame and within its range: evenly
/// thinned to `most_points`. Inside the view the frame itself is the better and newer witness. Surfaces that
/// were seen from the other side (by their normals, if the map has them) are left out: whoever reads the points
/// takes all for seen from here, and a thin wall would be matched with its back.
[[nodiscard]] Cloud outside_view(const Cloud& map_odom, const Pose& T_odom_sensor, const SensorView& view,
                                 std::size_t most_points);

}  // namespace liloc
