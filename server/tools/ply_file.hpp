#pragma once
#include <filesystem>

#include "common/geometry/cloud.hpp"

namespace liloc::toolbox {

/// The vertices of a PLY file: ASCII or binary in either byte order, coordinates of any scalar type, whatever
/// else the file holds. Points that are not finite are dropped. Errors name what is wrong and the remedy: a
/// header that does not fit the file, a type PLY does not know, vertices with a list or without x, y or z.
[[nodiscard]] Result<Cloud> read_ply(const std::filesystem::path& file);

}  // namespace liloc::toolbox
