#pragma once
#include <filesystem>

#include "common/geometry/cloud.hpp"

namespace liloc::toolbox {

/// Reads a PCD or PLY file; points that are not finite are dropped, normals are not read. Errors: not there,
/// neither of the two, malformed, no finite point, more points than its size can hold.
[[nodiscard]] Result<Cloud> read_cloud_file(const std::filesystem::path& file);

}  // namespace liloc::toolbox
