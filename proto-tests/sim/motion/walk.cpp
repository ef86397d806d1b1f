#include "proto-tests/sim/motion/walk.hpp"

#include <algorithm>
#include <cmath>
#include <deque>
#include <numbers>

namespace liloc::sim {
namespace {

using Eigen::Vector2d;
constexpr double kPersonalSpace = 0.6;  // metres between two bodies' middles
constexpr double kPatience_s = 1.0;     // then one turns round and goes elsewhere
constexpr double kOffWall_m = 1.5;      // for the goals of a device
constexpr double kFarEnough_m = 3.0;    // for a goal, where the site has such a place

double wrapped(double angle_rad) {
  return std::remainder(angle_rad, 2 * std::numbers::pi);
}

struct Walker {
  WalkStyle style;
  WalkState state;
  std::deque<Vector2d> way;
  double rest_s = 0, blocked_s = 0;
};

bool in_the_way(const Walker& self, const Vector2d& next, const std::vector<Walker>& all) {
  return std::ranges::any_of(all, [&](const Walker& other) {
    if (&other == &self) return false;
    const double now = (other.state.at - self.state.at).norm(), then = (other.state.at - next).norm();
    return then < kPersonalSpace && then < now;
  });
}

/// A place worth going to: far enough, and for some away from the walls and the farthest of a few.
Vector2d draw_goal(Random& random, const FloorPlan& plan, const Walker& walker) {
  Vector2d best = plan.random_place(random);
  for (int i = 0, choices = walker.style.across_the_room ? 6 : 1; i < choices; ++i) {
    Vector2d goal = plan.random_place(random);
    for (int k = 0; k < 10 && walker.style.across_the_room && plan.distance_to_wall_m(goal) < kOffWall_m; ++k)
      goal = plan.random_place(random);
    if ((goal - walker.state.at).norm() > (best - walker.state.at).norm() || i == 0) best = goal;
  }
  return best;
}

void choose_goal(Random& random, const FloorPlan& plan, Walker& walker) {
  for (int i = 0; i < 20 && walker.way.empty(); ++i) {
    const Vector2d goal = draw_goal(random, plan, walker);
    if ((goal - walker.state.at).norm() < kFarEnough_m / (1 + 0.2 * i)) continue;
    const auto way = plan.route(plan.nearest_free(walker.state.at), goal);
    walker.way.assign(way.begin(), way.end());
  }
}

/// Turns towards `aim`; returns how far off it still looks.
double turn(Walker& walker, const Vector2d& aim) {
  const Vector2d ahead = aim - walker.state.at;
  if (ahead.norm() < 0.05) return 0;
  const double off = wrapped(std::atan2(ahead.y(), ahead.x()) - walker.state.yaw_rad);
  const double most = walker.style.turn_rad_s * kWalkStep_s;
  walker.state.yaw_rad += std::clamp(off, -most, most);
  return std::abs(off);
}

/// Goes round whoever stands in the way of `step`, on the right where there is room, else on the left, else
/// waits.
void step_aside(const FloorPlan& plan, Walker& walker, const Vector2d& step, const std::vector<Walker>& all) {
  for (const double by_rad : {-0.7, 0.7, -1.2, 1.2, -1.7, 1.7}) {
    const Vector2d aside = walker.state.at + Eigen::Rotation2Dd(by_rad) * (0.7 * step);
    if (!plan.is_free(aside) || in_the_way(walker, aside, all)) continue;
    const auto way = plan.route(aside, walker.way.back());
    if (way.empty()) continue;
    walker.state.at = aside;
    walker.state.speed_m_s *= 0.7;
    walker.way.assign(way.begin(), way.end());
    return;
  }
  walker.state.speed_m_s = 0;
}

/// One step along the way, unless a body stands there.
void advance(const FloorPlan& plan, Walker& walker, const std::vector<Walker>& all) {
  const double off = turn(walker, walker.way.front());
  const double limit = walker.style.turns_first ? 0.2 : 1.2;
  const double wanted = off > limit ? 0.0 : walker.style.speed_m_s;
  const double gain = walker.style.speed_m_s * 2 * kWalkStep_s;  // half a second to full speed
  walker.state.speed_m_s = std::clamp(wanted, walker.state.speed_m_s - gain, walker.state.speed_m_s + gain);
  double left = walker.state.speed_m_s * kWalkStep_s;
  Vector2d next = walker.state.at;
  auto corner = walker.way.begin();
  for (; corner != walker.way.end() && left > 0; ++corner) {
    const Vector2d leg = *corner - next;
    if (leg.norm() > left) {
      next += leg * (left / leg.norm());
      break;
    }
    next = *corner;
    left -= leg.norm();
  }
  if (in_the_way(walker, next, all)) {
    walker.blocked_s += kWalkStep_s;
    step_aside(plan, walker, next - walker.state.at, all);
    return;
  }
  walker.blocked_s = 0;
  walker.state.at = next;
  walker.way.erase(walker.way.begin(), corner);
}

void step(Random& random, const FloorPlan& plan, Walker& walker, const std::vector<Walker>& all,
          double time_s) {
  if (time_s < walker.style.start_s || walker.rest_s > 0) {
    walker.rest_s -= kWalkStep_s;
    walker.state.speed_m_s = 0;
    return;
  }
  if (walker.blocked_s > kPatience_s) {
    walker.way.clear();
    walker.blocked_s = 0;
  }
  const bool arrived = walker.way.empty();
  if (arrived) choose_goal(random, plan, walker);
  if (arrived && random.chance(walker.style.pause_chance)) walker.rest_s = random.uniform(0.5, 3);
  if (!walker.way.empty() && walker.rest_s <= 0) advance(plan, walker, all);
}

/// Stands where its style wants it, or as near as others leave room.
void take_place(Random& random, const FloorPlan& plan, const std::vector<Walker>& others, Walker& walker) {
  walker.state.yaw_rad = walker.style.start->yaw_rad;
  for (int i = 0; i < 50; ++i) {
    const Vector2d by(random.uniform(-1, 1), random.uniform(-1, 1));
    walker.state.at = plan.nearest_free(walker.style.start->at + 0.08 * i * by);
    if (std::ranges::all_of(others, [&](const Walker& w) {
          return (w.state.at - walker.state.at).norm() > kPersonalSpace + 0.05;
        }))
      return;
  }
}

}  // namespace

std::vector<Walk> draw_walks(Random& random, const FloorPlan& plan, const std::vector<WalkStyle>& styles,
                             double seconds) {
  std::vector<Walker> walkers;
  for (const WalkStyle& style : styles) {
    Walker walker;
    walker.style = style;
    if (style.start) {
      take_place(random, plan, walkers, walker);
      walkers.push_back(std::move(walker));
      continue;
    }
    for (int i = 0; i < 50; ++i) {
      walker.state.at = plan.random_place(random);
      if (std::ranges::all_of(walkers,
                              [&](const Walker& w) { return (w.state.at - walker.state.at).norm() > 1.2; }))
        break;
    }
    choose_goal(random, plan, walker);  // look where the way will lead
    if (walker.way.size() > 1) {
      const Vector2d ahead = walker.way[1] - walker.state.at;
      walker.state.yaw_rad = std::atan2(ahead.y(), ahead.x());
    }
    walkers.push_back(std::move(walker));
  }
  std::vector<Walk> walks(styles.size());
  for (int i = 0; i * kWalkStep_s < seconds + 1; ++i)
    for (std::size_t w = 0; w < walkers.size(); ++w) {
      walks[w].push_back(walkers[w].state);
      step(random, plan, walkers[w], walkers, i * kWalkStep_s);
    }
  return walks;
}

WalkState state_at(const Walk& walk, double time_s) {
  const double position = std::clamp(time_s / kWalkStep_s, 0.0, static_cast<double>(walk.size() - 1));
  const auto before = static_cast<std::size_t>(position);
  const std::size_t after = std::min(before + 1, walk.size() - 1);
  const double share = position - static_cast<double>(before);
  const WalkState &a = walk[before], &b = walk[after];
  return {a.at + share * (b.at - a.at), a.yaw_rad + share * (b.yaw_rad - a.yaw_rad),
          a.speed_m_s + share * (b.speed_m_s - a.speed_m_s)};
}

}  // namespace liloc::sim
