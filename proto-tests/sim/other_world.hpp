#pragma once
// World 2: rooms, furniture, crowds and LiDAR mounts as another simulator would draw them. What was tuned on
// world 1 is reported on this one.
#include "common/recording/recording.hpp"
#include "proto-tests/sim/floor_plan.hpp"
#include "proto-tests/sim/people.hpp"

namespace liloc::sim {

/// Ceiling heights of world 2: low offices, high halls.
[[nodiscard]] double draw_other_height_m(Random& random, SiteKind kind);
/// Half-open walls, ducts under the ceiling; size in metres.
[[nodiscard]] Mesh make_other_room(Random& random, const SimOptions& options, const Eigen::Vector3d& size_m);
/// By the seed a lounge, a workshop, a store or a near-empty room; halls have aisles.
void furnish_other(Random& random, const SimOptions& options, Layout& layout);

/// One person of a crowd.
struct Visitor {
  WalkStyle style;
  Posture posture = Posture::walking;
};
/// People who stand in groups and talk, sit, or hurry. `count` of them.
[[nodiscard]] std::vector<Visitor> draw_visitors(Random& random, const FloorPlan& plan, int count);

/// Where a LiDAR of world 2 hangs: anywhere along the walls, at 2.3 to 4 m, tilted as it came.
[[nodiscard]] Pose draw_other_mount(Random& random, int index, int count, const Eigen::Vector3d& size_m);

}  // namespace liloc::sim
