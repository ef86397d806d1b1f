#pragma once
#include "common/geometry/cloud.hpp"

namespace liloc {

/// How far a cloud spans along the longest axis, between the 2nd and the 98th hundredth: a few stray points do
/// not make it large. 0 without a finite point.
[[nodiscard]] double extent_m(const Cloud& cloud);

}  // namespace liloc
