#pragma once
// Everyone's ways through the site, drawn together so that they stay out of each other's way.
#include <optional>
#include <vector>

#include "proto-tests/sim/site/floor_plan.hpp"

namespace liloc::sim {

constexpr double kWalkStep_s = 0.1;  // between the places of a walk, which a spline joins; by hand

struct WalkStyle {
  double speed_m_s = 1.2;
  double turn_rad_s = 1.5;
  double start_s = 0;              ///< stands still until then
  double pause_chance = 0.3;       ///< of standing for a while at each goal
  bool turns_first = false;        ///< drives only where it looks
  bool across_the_room = false;    ///< prefers far goals off the walls: a device is shown the room, not a wall
  std::optional<Placement> start;  ///< near here at first, looking so; else anywhere
};

struct WalkState {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
  double yaw_rad = 0;  ///< continuous, may pass a full turn
  double speed_m_s = 0;
};

using Walk = std::vector<WalkState>;  ///< every kWalkStep_s from time 0

/// One walk per style. `plan` must not be empty.
[[nodiscard]] std::vector<Walk> draw_walks(Random& random, const FloorPlan& plan,
                                           const std::vector<WalkStyle>& styles, double seconds);

/// Linear between the steps; before the first and after the last it stands.
[[nodiscard]] WalkState state_at(const Walk& walk, double time_s);

}  // namespace liloc::sim
