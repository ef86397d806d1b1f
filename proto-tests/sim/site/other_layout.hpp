#pragma once
// Rooms and furniture of world 2, as another simulator would draw them.
#include "proto-tests/sim/site/layout.hpp"

namespace liloc::sim {

/// Ceiling heights of world 2: low offices, high halls.
[[nodiscard]] double draw_other_height_m(Random& random, SiteKind kind);
/// Half-open walls, ducts under the ceiling; size in metres.
[[nodiscard]] Mesh make_other_room(Random& random, const SimOptions& options, const Eigen::Vector3d& size_m);
/// By the seed a lounge, a workshop, a store or a near-empty room; halls have aisles.
void furnish_other(Random& random, const SimOptions& options, Layout& layout);

}  // namespace liloc::sim
