#include "proto-tests/sim/site/other_layout.hpp"

#include <algorithm>
#include <cmath>

#include "proto-tests/sim/site/furnisher.hpp"
#include "proto-tests/sim/site/other_furniture.hpp"
#include "proto-tests/sim/site/room.hpp"

namespace liloc::sim {
namespace {

using Eigen::Vector3d;
constexpr double kRackTop_m = 2.25;     // under the lowest LiDAR with what lies on top
constexpr double kDuctOffWall_m = 0.9;  // by hand

enum class Flavour { lounge, workshop, store, empty };

/// As furniture per square metre of floor, at clutter 1.
struct Density {
  double sofas, tables, stools, poles, boards, racks, machines, trolleys, boxes, doors;
};
constexpr Density density_of(Flavour flavour) {
  switch (flavour) {
    case Flavour::lounge:
      return {.06, .08, .10, .03, .01, 0, 0, 0, 0, .015};
    case Flavour::workshop:
      return {0, .02, .03, .02, .02, .01, .06, .05, .04, .01};
    case Flavour::store:
      return {0, 0, .01, .01, 0, .08, .01, .04, .06, .005};
    case Flavour::empty:
      break;
  }
  return {.01, .02, .02, .02, .015, 0, .005, .01, .005, .01};
}

/// Rows of racks with ways between them.
void add_aisles(Random& random, Furnisher& furnisher, const Vector3d& size, double clutter) {
  const double way_m = random.uniform(2.0, 4.0), from = random.uniform(2.0, 4.0);
  const double end = size.x() * random.uniform(0.4, 0.8);
  for (double y = from; y < size.y() - 2.0; y += way_m + 1.0)
    for (double x = from; x < end; x += random.uniform(2.6, 3.4))
      if (random.chance(std::min(0.9, 0.6 * clutter)))
        furnisher.at(make_pallet_rack(random, kRackTop_m), {{x, y}, 0.02 * random.normal()}, 0.02);
}

/// Clear of the walls, where LiDARs hang.
void add_ducts(Mesh& mesh, Random& random, const Vector3d& size) {
  if (size.head<2>().minCoeff() < 2 * kDuctOffWall_m + 1) return;
  for (int i = random.below(4); i > 0; --i) {
    const double z = size.z() - random.uniform(0.15, 0.4), thick = random.uniform(0.12, 0.4);
    const int along = random.below(2), across = 1 - along;
    Vector3d at(0, 0, z), measures(thick, thick, thick);
    at[along] = 0.5 * size[along];
    at[across] = random.uniform(kDuctOffWall_m, size[across] - kDuctOffWall_m);
    measures[along] = size[along] - 2 * kDuctOffWall_m;
    add_box(mesh, at, measures);
  }
}

}  // namespace

double draw_other_height_m(Random& random, SiteKind kind) {
  if (kind == SiteKind::area) return random.uniform(3.2, 6.5);
  return kind == SiteKind::corridor ? random.uniform(2.4, 3.2) : random.uniform(2.45, 3.4);
}

Mesh make_other_room(Random& random, const SimOptions& options, const Vector3d& size) {
  const bool symmetric = options.kind == SiteKind::symmetric;
  const Material floor = random.chance(0.5) ? Material::carpet : Material::matte;
  Mesh mesh = make_room(random, size, {symmetric, floor, true});
  if (!symmetric) add_ducts(mesh, random, size);
  return mesh;
}

void furnish_other(Random& random, const SimOptions& options, Layout& layout) {
  const bool symmetric = options.kind == SiteKind::symmetric, corridor = options.kind == SiteKind::corridor;
  const bool hall = options.kind == SiteKind::area;
  Furnisher furnisher(random, layout.size_m, symmetric, layout.items);
  const auto flavour = static_cast<Flavour>(corridor ? 3 : random.below(4));
  const double floor_m2 = layout.size_m.x() * layout.size_m.y() * (symmetric ? 0.5 : 1.0);
  const double area = options.clutter * floor_m2 * (hall ? 0.5 : 1.0);
  const auto times = [&](double count, auto&& put) {
    for (int i = 0; i < static_cast<int>(count + random.unit()); ++i) put();
  };
  if (hall) times(floor_m2 / 70, [&] { furnisher.pillar(make_column(random, layout.size_m.z())); });
  if (hall && flavour == Flavour::store) add_aisles(random, furnisher, layout.size_m, options.clutter);
  const Density d = density_of(flavour);
  times(area * d.doors, [&] { furnisher.along_wall(make_door_leaf(random), 0.1); });
  if (!corridor) {
    times(area * d.racks, [&] { furnisher.anywhere(make_pallet_rack(random, kRackTop_m), 0.7, true); });
    times(area * d.machines, [&] { furnisher.anywhere(make_machine(random), 0.6, random.chance(0.7)); });
  }
  times(area * d.sofas, [&] { furnisher.along_wall(make_sofa(random), 0.3); });
  times(area * d.boards, [&] { furnisher.anywhere(make_whiteboard(random), 0.4, false); });
  times(area * d.tables, [&] { furnisher.anywhere(make_round_table(random), 0.5, false); });
  times(area * d.trolleys, [&] { furnisher.along_wall(make_trolley(random), 0.1); });
  times(area * d.stools, [&] { furnisher.anywhere(make_stool(random), 0.2, false); });
  times(area * d.poles, [&] { furnisher.along_wall(make_pole(random), 0.1); });
  times(area * d.boxes, [&] { furnisher.anywhere(make_box(random), 0.2, false); });
}

}  // namespace liloc::sim
