#pragma once
// Crowds of world 2, as another simulator would draw them.
#include "proto-tests/sim/motion/people.hpp"
#include "proto-tests/sim/site/floor_plan.hpp"

namespace liloc::sim {

/// One person of a crowd.
struct Visitor {
  WalkStyle style;
  Posture posture = Posture::walking;
};
/// People who stand in groups and talk, sit, or hurry. `count` of them.
[[nodiscard]] std::vector<Visitor> draw_visitors(Random& random, const FloorPlan& plan, int count);

}  // namespace liloc::sim
