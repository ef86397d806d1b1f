#include "proto-tests/sim/site/layout.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "proto-tests/sim/site/furnisher.hpp"
#include "proto-tests/sim/site/other_layout.hpp"
#include "proto-tests/sim/site/room.hpp"

namespace liloc::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
constexpr double kHalfTurn = std::numbers::pi;
constexpr int kTries = 60;  // to find another place for a piece

void furnish(Random& random, const SimOptions& options, Layout& layout) {
  const bool symmetric = options.kind == SiteKind::symmetric, corridor = options.kind == SiteKind::corridor;
  Furnisher furnisher(random, layout.size_m, symmetric, layout.items);
  const double floor_m2 = layout.size_m.x() * layout.size_m.y() * (symmetric ? 0.5 : 1.0);
  const double wall_m = 2 * (layout.size_m.x() + layout.size_m.y()) * (symmetric ? 0.5 : 1.0);
  const double area = options.clutter * floor_m2, around = options.clutter * wall_m;
  const auto times = [&](double count, auto&& put) {
    for (int i = 0; i < static_cast<int>(count + random.unit()); ++i) put();
  };
  if (options.kind == SiteKind::area) {
    times(floor_m2 / 40, [&] { furnisher.pillar(make_pillar(random, layout.size_m.z())); });
    times(floor_m2 / 35, [&] { furnisher.anywhere(make_partition(random), 0.9, true); });
  } else if (!corridor) {
    times(0.7, [&] { furnisher.pillar(make_pillar(random, layout.size_m.z())); });
  }
  times(around / (corridor ? 14 : 8), [&] { furnisher.along_wall(make_shelf(random), 0.1); });
  times(around / 12, [&] { furnisher.along_wall(make_cabinet(random), 0.1); });
  if (!corridor) {
    times(area / 26, [&] { furnisher.along_wall(make_desk(random), 0.3); });
    times(area / 26, [&] { furnisher.anywhere(make_desk(random), 0.75, true); });
    const std::size_t desks = layout.items.size();
    for (std::size_t i = 0; i < desks; ++i) {
      const Item item = layout.items[i];  // a copy: the list grows
      if (item.furniture.half_size.x() > 0.55 && item.furniture.half_size.y() > 0.33 && random.chance(0.75))
        furnisher.at_desk(make_chair(random), item);
    }
    times(area / 18, [&] { furnisher.anywhere(make_chair(random), 0.3, false); });
  }
  times(area / 28, [&] { furnisher.along_wall(make_plant(random), 0.1); });
  times(area / 18, [&] { furnisher.anywhere(make_box(random), 0.2, false); });
}

/// Gives some movable pieces another place at the run's start, others a push during it.
void disturb(Random& random, const SimOptions& options, Layout& layout) {
  Furnisher furnisher(random, layout.size_m, false, layout.items);
  const auto near = [&](const Item& item) -> std::optional<Placement> {
    for (int i = 0; i < kTries; ++i) {
      const Vector2d by(random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2));
      const Placement to{item.start.at + by, item.start.yaw_rad + random.uniform(-1.5, 1.5)};
      if (by.norm() > 0.25 && furnisher.fits(item.furniture, to, 0.05, &item)) return to;
    }
    return std::nullopt;
  };
  const auto choose = [&](int count, auto&& change) {
    for (int tries = 0; count > 0 && tries < kTries && !layout.items.empty(); ++tries) {
      Item& item = layout.items[static_cast<std::size_t>(random.below(static_cast<int>(layout.items.size())))];
      if (!item.furniture.movable || item.push || item.start.at != item.reference.at) continue;
      if (const auto to = near(item)) {
        change(item, *to);
        --count;
      }
    }
  };
  choose(options.moved_items < 0 ? options.people / 2 : options.moved_items,
         [](Item& item, const Placement& to) { item.start = to; });
  choose(options.pushed_items < 0 ? options.people / 3 : options.pushed_items,
         [&](Item& item, const Placement& to) {
           const double from_s = std::min(options.still_seconds, 0.5 * options.seconds);
           item.push = Push{random.uniform(from_s, options.seconds), 1.5, to};
         });
}

Vector3d draw_size(Random& random, const SimOptions& options) {
  const Vector3d usual[] = {{10, 8, 3.5}, {20, 2.6, 2.8}, {10, 8, 3.5}, {24, 16, 4}};
  const Vector3d asked(options.width_m, options.depth_m, options.height_m);
  Vector3d size = usual[static_cast<int>(options.kind)];
  for (int axis = 0; axis < 3; ++axis) {
    const double share =
        axis == 2 ? 0.04 : 0.08;  // drawn in any case, so that one asked size leaves the others alone
    size[axis] *= random.uniform(1 - share, 1 + share);
    if (asked[axis] > 0) size[axis] = asked[axis];
  }
  return size;
}

}  // namespace

bool too_close(const Placement& a, const Vector2d& half_a, const Placement& b, const Vector2d& half_b,
               double gap_m) {
  const Vector2d between = b.at - a.at;
  for (const double yaw : {a.yaw_rad, a.yaw_rad + 0.5 * kHalfTurn, b.yaw_rad, b.yaw_rad + 0.5 * kHalfTurn}) {
    const Vector2d axis(std::cos(yaw),
                        std::sin(yaw));  // apart along any side's direction: apart (separating axis)
    const auto reach = [&](const Placement& p, const Vector2d& half) {
      return half.x() * std::abs(std::cos(p.yaw_rad - yaw)) + half.y() * std::abs(std::sin(p.yaw_rad - yaw));
    };
    if (std::abs(between.dot(axis)) > reach(a, half_a) + reach(b, half_b) + gap_m) return false;
  }
  return true;
}

Pose Item::T_map_item(double time_s) const {
  Placement now = start;
  if (push) {
    const double share = std::clamp((time_s - push->start_s) / push->seconds, 0.0, 1.0);
    const double eased = share * share * (3 - 2 * share);
    now.at += eased * (push->to.at - start.at);
    now.yaw_rad += eased * (push->to.yaw_rad - start.yaw_rad);
  }
  return upright({now.at.x(), now.at.y(), 0}, now.yaw_rad);
}

Layout make_layout(const SimOptions& options) {
  Layout layout;
  Random shell(options.seed, 1), furniture(options.seed, 2), moves(options.seed, 3);
  layout.size_m = draw_size(shell, options);
  if (options.world == 2) {
    layout.size_m.z() = options.height_m > 0 ? options.height_m : draw_other_height_m(shell, options.kind);
    layout.room = make_other_room(shell, options, layout.size_m);
    furnish_other(furniture, options, layout);
  } else {
    Random floor(options.seed, 4);
    const Material material = floor.chance(0.5) ? Material::carpet : Material::matte;
    layout.room = make_room(shell, layout.size_m, {options.kind == SiteKind::symmetric, material, false});
    furnish(furniture, options, layout);
  }
  disturb(moves, options, layout);
  return layout;
}

}  // namespace liloc::sim
