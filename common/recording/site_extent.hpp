#pragma once
#include <string>
#include <vector>

#include "common/recording/recording.hpp"

namespace liloc {

/// Whether the LiDARs of a site hang where those of one site can: grids cover the extent of rooms that hang
/// together, and floats of the map are coarse far from its origin. `file` begins the error, which names the
/// LiDAR that hangs farthest off.
[[nodiscard]] Status check_extent(const std::string& file, const std::vector<GlobalLidar>& lidars);

}  // namespace liloc
