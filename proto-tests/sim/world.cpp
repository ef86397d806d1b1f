#include "proto-tests/sim/world.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "proto-tests/sim/motion/other_people.hpp"

namespace liloc::sim {
namespace {

constexpr double kBodyRadius_m = 0.38;  // floor plan clearance: a body and some air
constexpr double kArmLength_m = 0.42;   // from a carrier's middle to the device
constexpr double kRobotBack_m = 0.18;   // from a robot's middle to its sensor
constexpr double kStep_m = 0.7;         // of a walking person
constexpr double kRobotHeight_m = 0.8;  // of its sensor, as options.hpp says

WalkStyle device_style(Random& random, const SimOptions& options) {
  WalkStyle style;
  const bool robot = options.device_kind == DeviceKind::robot;
  style.speed_m_s = robot ? random.uniform(0.15, 0.5) : random.uniform(0.7, 1.0);
  if (options.device_speed_m_s > 0) style.speed_m_s = options.device_speed_m_s;
  style.turn_rad_s = robot ? 0.3 : 1.1;
  style.turns_first = robot;
  style.start_s = options.still_seconds + 0.5;
  style.pause_chance = 0.15;
  style.across_the_room = options.world != 2 || random.chance(0.5);
  return style;
}

/// World 2 has children and tall people, and phones held overhead.
double carried_height_m(Random& hand, const SimOptions& options) {
  return options.world == 2 ? hand.uniform(0.8, 1.7) : hand.uniform(1.0, 1.2);
}

}  // namespace

Result<World> World::create(const SimOptions& options) {
  auto caster = RayCaster::create(options.threads);
  if (!caster) return tl::unexpected(caster.error());
  World world(make_layout(options), std::move(*caster));
  if (auto added = world.add_furniture(); !added) return tl::unexpected(added.error());
  if (auto added = world.populate(options); !added) return tl::unexpected(added.error());
  return world;
}

Status World::add_furniture() {
  Mesh still = layout_.room;
  for (std::size_t i = 0; i < layout_.items.size(); ++i) {
    const Item& item = layout_.items[i];
    if (!item.push) {
      add_mesh(still, item.furniture.mesh, item.T_map_item(0));
      continue;
    }
    const auto number = caster_.add(item.furniture.mesh);
    if (!number) return tl::unexpected(number.error());
    item_numbers_.push_back(*number);
    pushed_items_.push_back(i);
  }
  const auto number = caster_.add(still);
  return number ? Status{} : tl::unexpected(number.error());
}

Status World::add_mover(Body body, Walk walk, int device) {
  Mover mover{std::move(body), {}, std::move(walk), {}, device};
  double stride_rad = 0;
  for (const WalkState& state : mover.walk) {
    mover.stride_rad.push_back(stride_rad);
    stride_rad += std::numbers::pi * state.speed_m_s * kWalkStep_s / kStep_m;
  }
  for (const Mesh& part : mover.body.parts()) {
    const auto number = caster_.add(part);
    if (!number) return tl::unexpected(number.error());
    mover.numbers.push_back(*number);
  }
  movers_.push_back(std::move(mover));
  return {};
}

Status World::populate(const SimOptions& options) {
  if (options.people + options.devices == 0) return {};
  const FloorPlan plan(layout_, kBodyRadius_m);
  if (plan.empty())
    return fail("sim: nobody can walk in a site of {:.1f} x {:.1f} m; raise width_m or depth_m",
                layout_.size_m.x(), layout_.size_m.y());
  Random draw(options.seed, 10), shapes(options.seed, 11);
  std::vector<WalkStyle> styles;
  for (int i = 0; i < options.devices; ++i) styles.push_back(device_style(draw, options));
  std::vector<Visitor> visitors;
  if (options.world == 2) {
    visitors = draw_visitors(draw, plan, options.people);
    for (const Visitor& visitor : visitors) styles.push_back(visitor.style);
  } else {
    for (int i = 0; i < options.people; ++i)
      styles.push_back({draw.uniform(0.9, 1.4), 2.5, draw.uniform(0, 2), 0.35, false, false, std::nullopt});
  }
  const auto carriers = static_cast<std::size_t>(options.devices);
  const auto walks = draw_walks(draw, plan, styles, options.seconds);
  const bool robot = options.device_kind == DeviceKind::robot;
  for (std::size_t i = 0; i < walks.size(); ++i) {
    const bool carries = i < carriers;
    if (carries) {
      Random hand(options.seed, 100 + i);
      devices_.push_back(
          sensor_trajectory(hand, walks[i], robot ? Carriage::wheels : Carriage::hand, plan.middle(),
                            robot ? kRobotHeight_m : carried_height_m(hand, options), options.still_seconds));
    }
    Body body = carries && robot ? Body::robot()
                : options.world == 2
                    ? Body::visitor(shapes, carries ? Posture::walking : visitors[i - carriers].posture)
                    : Body::person(shapes);
    if (auto added = add_mover(std::move(body), walks[i], carries ? static_cast<int>(i) : -1); !added)
      return added;
  }
  return {};
}

void World::pose(const Mover& mover, double time_s) {
  const WalkState state = state_at(mover.walk, time_s);
  const auto step = std::min(static_cast<std::size_t>(time_s / kWalkStep_s), mover.stride_rad.size() - 1);
  const double stride = mover.stride_rad[step] + std::numbers::pi * state.speed_m_s / kStep_m *
                                                     (time_s - static_cast<double>(step) * kWalkStep_s);
  Pose T_map_body = upright({state.at.x(), state.at.y(), 0}, state.yaw_rad);
  if (mover.device >= 0) {  // behind its device, which moves more smoothly than the walk
    const bool robot = mover.body.parts().size() == 1;
    const Eigen::Vector3d device =
        devices_[static_cast<std::size_t>(mover.device)].at(time_s).T_map_sensor.translation();
    T_map_body.translation() = Eigen::Vector3d(device.x(), device.y(), 0) -
                               (robot ? kRobotBack_m : kArmLength_m) * T_map_body.linear().col(0);
  }
  const double gesture_hz = mover.body.gesture_hz();
  const double swing = gesture_hz > 0 ? 1.0 : std::min(1.0, state.speed_m_s);
  const double phase_rad = stride + 2 * std::numbers::pi * gesture_hz * time_s;
  for (std::size_t part = 0; part < mover.numbers.size(); ++part)
    caster_.move(mover.numbers[part], mover.body.T_map_part(part, T_map_body, phase_rad, swing));
}

void World::move_to(double time_s) {
  if (time_s == posed_at_s_) return;
  for (std::size_t i = 0; i < pushed_items_.size(); ++i)
    caster_.move(item_numbers_[i], layout_.items[pushed_items_[i]].T_map_item(time_s));
  for (const Mover& mover : movers_) pose(mover, time_s);
  caster_.commit();
  posed_at_s_ = time_s;
}

View World::look(double time_s, const Camera& camera, const Pose& T_map_camera, double range_m) {
  move_to(std::max(0.0, time_s));
  return caster_.look(camera, T_map_camera, range_m);
}

}  // namespace liloc::sim
