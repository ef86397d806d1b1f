#pragma once
#include <filesystem>

#include "common/geometry/cloud.hpp"

namespace liloc::toolbox {

/// Reads a PCD or PLY file; points that are not finite are dropped, normals are not read. Errors: not there,
/// neither of the two, malformed, no finite point, more points than its size can hold.
[[nodiscard]] Result<Cloud> read_cloud_file(const std::filesystem::path& file);

/// A cloud about a place of its file's coordinates.
struct PlacedCloud {
  Cloud cloud;
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
};
/// The same; what lies far from the file's origin, as a scan in the coordinates of a survey does, about its own
/// middle: floats would be too coarse, and nothing was seen from there.
[[nodiscard]] Result<PlacedCloud> read_placed_cloud(const std::filesystem::path& file);

/// The same, of a scan in the frame of a site's map, which is kept in floats. Errors: also over 16 km from its
/// origin, as in the coordinates of a survey.
[[nodiscard]] Result<Cloud> read_map_scan(const std::filesystem::path& file);

}  // namespace liloc::toolbox
