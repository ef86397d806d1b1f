#pragma once
#include <Eigen/Core>
#include <filesystem>
#include <vector>

#include "common/base/result.hpp"

namespace liloc::toolbox {

using Points = std::vector<Eigen::Vector3d>;

/// The vertices of a PLY file: ASCII or binary in either byte order, coordinates of any scalar type, whatever
/// else the file holds. Points that are not finite are dropped. Errors name what is wrong and the remedy: a
/// header that does not fit the file, a type PLY does not know, vertices with a list or without x, y or z.
[[nodiscard]] Result<Points> read_ply(const std::filesystem::path& file);

}  // namespace liloc::toolbox
