#include "proto-tests/sim/motion/other_people.hpp"

#include <cmath>
#include <numbers>

namespace liloc::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
constexpr double kHurryShare = 0.4, kSitShare = 0.25;  // of a crowd; by hand, the rest stands in groups
constexpr double kWholeRun_s = 1e9;                    // longer than any run

WalkStyle hurrying(Random& random) {
  return {random.uniform(1.2, 2.0), 3.0, random.uniform(0, 1.5), 0.1, false, false, std::nullopt};
}

WalkStyle staying(const Vector2d& at, double yaw_rad) {
  WalkStyle style;
  style.start_s = kWholeRun_s;
  style.start = Placement{at, yaw_rad};
  return style;
}

}  // namespace

std::vector<Visitor> draw_visitors(Random& random, const FloorPlan& plan, int count) {
  std::vector<Visitor> crowd;
  const auto wanted = static_cast<std::size_t>(count);
  while (crowd.size() < wanted) {
    if (random.chance(kHurryShare)) {
      crowd.push_back({hurrying(random), Posture::walking});
      continue;
    }
    const Vector2d middle = plan.random_place(random);
    const bool sit = random.chance(kSitShare);
    const std::size_t members = sit ? 1 : 2 + static_cast<std::size_t>(random.below(3));
    const double first = random.uniform(0, 2 * std::numbers::pi), radius = random.uniform(0.5, 0.8);
    for (std::size_t i = 0; i < members && crowd.size() < wanted; ++i) {
      const double at = first + 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(members);
      const Vector2d off = radius * Vector2d(std::cos(at), std::sin(at));
      crowd.push_back({staying(middle + off, at + std::numbers::pi + random.uniform(-0.5, 0.5)),
                       sit ? Posture::sitting : Posture::standing});
    }
  }
  return crowd;
}

Body Body::visitor(Random& random, Posture posture) {
  const bool sits = posture == Posture::sitting;
  const double height = random.uniform(1.45, 2.0), stout = random.uniform(0.85, 1.5);
  const double hip = sits ? 0.5 : random.uniform(0.46, 0.54) * height,
               torso = random.uniform(0.29, 0.34) * height;
  const double shoulder = hip + torso, head = shoulder + 0.14 * height;
  const auto cloth = [&] { return random.chance(0.4) ? Material::dark : Material::matte; };
  Body body;
  Mesh trunk;
  const double deep = 0.11 * stout, broad = 0.17 + 0.03 * stout;
  add_cylinder(trunk, {0, 0, hip - 0.05}, broad, 0.8 * broad, torso, 10, cloth());
  if (!sits && random.chance(0.35))  // a coat or a skirt
    add_cylinder(trunk, {0, 0, hip - random.uniform(0.25, 0.45)}, broad + 0.12, broad, 0.45, 10, cloth());
  if (random.chance(0.35))  // a rucksack
    add_box(trunk, Vector3d(-deep - 0.12, 0, hip + 0.6 * torso), {0.2, 0.3, 0.42}, cloth());
  add_ellipsoid(trunk, {0.02, 0, head}, {0.1, 0.08, 0.12}, 7,
                random.chance(0.6) ? Material::dark : Material::matte);
  if (random.chance(0.2)) add_cylinder(trunk, {0, 0, head + 0.05}, 0.17, 0.1, 0.08, 10);  // a hat
  const auto add = [&](Mesh mesh, const Vector3d& joint, double swing, double rest) {
    body.parts_.push_back(std::move(mesh));
    body.joints_.push_back(joint);
    body.swings_rad_.push_back(swing);
    body.rests_rad_.push_back(rest);
  };
  if (sits) {
    add_box(trunk, Vector3d(0.2, 0, hip - 0.02), {0.5, 0.34, 0.14}, cloth());
    add_box(trunk, Vector3d(0.42, 0, 0.5 * hip), {0.14, 0.3, hip}, cloth());
    add_cylinder(trunk, {0, 0, 0}, 0.2, 0.2, hip - 0.08, 10);  // the stool
  }
  add(std::move(trunk), Vector3d::Zero(), 0, 0);
  const bool walks = posture == Posture::walking;
  const bool gestures = !walks && random.chance(0.6);
  body.gesture_hz_ = gestures ? random.uniform(0.4, 1.2) : 0;
  const double arm_length = 0.4 * height;
  for (const double side : {1.0, -1.0}) {
    Mesh arm;
    add_cylinder(arm, {0, 0, -arm_length}, 0.04, 0.045 * stout, arm_length, 8, cloth());
    const double raised = gestures ? -random.uniform(0.3, 1.4) : 0;  // about y: forward and up
    add(std::move(arm), {0, side * (broad + 0.02), shoulder - 0.06}, side * (walks ? 0.6 : 0.4 * gestures),
        raised);
    if (sits) continue;
    Mesh leg;
    add_cylinder(leg, {0, 0, -hip + 0.02}, 0.06, 0.07 * stout, hip, 8, cloth());
    add_box(leg, Vector3d(0.06, 0, -hip + 0.05), {0.28, 0.1, 0.1}, Material::dark);
    add(std::move(leg), {0, side * 0.1 * stout, hip}, walks ? side * -0.5 : 0, 0);
  }
  return body;
}

}  // namespace liloc::sim
