#pragma once
#include <filesystem>

#include "server/plan/outline.hpp"

namespace liloc::toolbox {

/// A floor plan drawn as a PNG of any colours: dark pixels are walls, also half transparent ones; the lower
/// left corner is the map's origin. `scale_m`: metres per pixel. Errors name the file and the remedy: no sound
/// PNG, over 64 million pixels, no dark pixel, a room under 1 or over 250 m.
[[nodiscard]] Result<plan::Outline> read_floor_image(const std::filesystem::path& file, double scale_m);

}  // namespace liloc::toolbox
