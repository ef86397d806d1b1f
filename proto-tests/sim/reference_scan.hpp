#pragma once
#include "common/geometry/cloud.hpp"
#include "proto-tests/sim/site/layout.hpp"

namespace liloc::sim {

/// The empty site before anything was moved, seen from many places by an exact sensor; a point every 4 cm, map
/// frame. Errors: Embree cannot start.
[[nodiscard]] Result<Cloud> scan_reference(const Layout& layout, int threads);

}  // namespace liloc::sim
