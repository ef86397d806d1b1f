#pragma once
#include <filesystem>
#include <optional>

#include "server/plan/outline.hpp"

namespace liloc::toolbox {

/// A floor plan of the walls that an ASCII DXF file draws in its ENTITIES: LINE, LWPOLYLINE and POLYLINE with
/// their bulges, ARC, CIRCLE. All else (texts, hatches, blocks, sheets in paper space) is passed over.
/// `scale_m`: metres per unit of the drawing; else what its $INSUNITS tells. Errors name the file, its line and
/// the remedy: no ASCII DXF, no unit, no wall, over 100 000 walls, a room under 1 or over 250 m.
[[nodiscard]] Result<plan::Outline> read_dxf(const std::filesystem::path& file, std::optional<double> scale_m);

}  // namespace liloc::toolbox
