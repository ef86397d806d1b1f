#include "proto-tests/sim/site/furniture.hpp"

#include <algorithm>

namespace liloc::sim {
namespace {

using Eigen::Vector3d;

/// Things lying about on a surface at `z` within +-half.
void add_clutter(Mesh& mesh, Random& random, double half_x, double half_y, double z, int count) {
  for (int i = 0; i < count; ++i) {
    const Vector3d size(random.uniform(0.06, 0.3), random.uniform(0.06, 0.25), random.uniform(0.02, 0.22));
    const Vector3d at(random.uniform(-half_x, half_x), random.uniform(-half_y, half_y), z + 0.5 * size.z());
    add_box(mesh, upright(at, random.uniform(-0.8, 0.8)), size,
            random.chance(0.2) ? Material::dark : Material::matte);
  }
}

void add_monitor(Mesh& mesh, Random& random, double x, double y, double z) {
  const double width = random.uniform(0.45, 0.7), height = 0.58 * width, lift = random.uniform(0.08, 0.18);
  const Pose T = upright({x, y, z}, random.uniform(-0.3, 0.3));
  const auto put = [&](const Vector3d& centre, const Vector3d& size, Material material) {
    add_box(mesh, T * upright(centre, 0), size, material);
  };
  put({0, 0, 0.01}, {0.24, 0.18, 0.02}, Material::dark);
  put({0, 0.04, 0.5 * lift + 0.02}, {0.06, 0.04, lift + 0.06}, Material::dark);
  put({0, 0, lift + 0.5 * height}, {width, 0.04, height}, Material::dark);
}

}  // namespace

Furniture make_desk(Random& random) {
  Furniture desk{{}, {random.uniform(0.6, 0.95), random.uniform(0.34, 0.43)}, random.chance(0.3)};
  const double x = desk.half_size.x(), y = desk.half_size.y(), top = random.uniform(0.68, 0.78);
  add_box(desk.mesh, Vector3d(0, 0, top - 0.015), {2 * x, 2 * y, 0.03});
  for (const double side_x : {-1.0, 1.0})
    for (const double side_y : {-1.0, 1.0})
      add_box(desk.mesh, Vector3d(side_x * (x - 0.04), side_y * (y - 0.04), 0.5 * (top - 0.03)),
              {0.05, 0.05, top - 0.03});
  if (random.chance(0.6))  // drawers on one side
    add_box(desk.mesh, Vector3d((random.chance(0.5) ? 1 : -1) * (x - 0.27), 0, 0.32), {0.4, 1.6 * y, 0.56});
  if (random.chance(0.35))
    add_box(desk.mesh, Vector3d(0, y - 0.02, 0.5 * top), {2 * x - 0.12, 0.02, 0.6 * top});
  const int monitors = random.below(3);
  for (int i = 0; i < monitors; ++i)
    add_monitor(desk.mesh, random, (i - 0.5 * (monitors - 1)) * 0.7 + random.uniform(-0.08, 0.08), 0.4 * y,
                top);
  add_clutter(desk.mesh, random, x - 0.15, y - 0.12, top, 1 + random.below(5));
  return desk;
}

Furniture make_chair(Random& random) {
  Furniture chair{{}, {random.uniform(0.22, 0.28), random.uniform(0.23, 0.29)}, true};
  const double x = chair.half_size.x(), y = chair.half_size.y(), seat = random.uniform(0.42, 0.5);
  add_box(chair.mesh, Vector3d(0, 0, seat), {2 * x, 2 * y, 0.06});
  Pose T_back = upright({0, y - 0.03, seat + random.uniform(0.25, 0.33)}, 0);
  T_back.rotate(Eigen::AngleAxisd(random.uniform(-0.25, -0.05), Vector3d::UnitX()));
  add_box(chair.mesh, T_back, {1.9 * x, 0.05, random.uniform(0.38, 0.6)});
  if (random.chance(0.5)) {  // office chair: column and five feet
    add_cylinder(chair.mesh, {0, 0, 0.06}, 0.03, 0.03, seat - 0.08, 8, Material::dark);
    for (int i = 0; i < 5; ++i)
      add_box(chair.mesh, upright({0, 0, 0.06}, 1.2566 * i) * upright({0.13, 0, 0}, 0), {0.26, 0.05, 0.05},
              Material::dark);
    for (const double side : {-1.0, 1.0})
      add_box(chair.mesh, Vector3d(side * x, 0, seat + 0.2), {0.05, 1.2 * y, 0.04});
  } else {
    for (const double side_x : {-1.0, 1.0})
      for (const double side_y : {-1.0, 1.0})
        add_box(chair.mesh, Vector3d(side_x * (x - 0.03), side_y * (y - 0.03), 0.5 * seat), {0.04, 0.04, seat});
  }
  return chair;
}

Furniture make_shelf(Random& random) {
  Furniture shelf{{}, {random.uniform(0.4, 0.75), random.uniform(0.15, 0.22)}, false};
  const double x = shelf.half_size.x(), y = shelf.half_size.y(), height = random.uniform(1.2, 2.2);
  for (const double side : {-1.0, 1.0})
    add_box(shelf.mesh, Vector3d(side * (x - 0.012), 0, 0.5 * height), {0.024, 2 * y, height});
  if (random.chance(0.6)) add_box(shelf.mesh, Vector3d(0, y - 0.006, 0.5 * height), {2 * x, 0.012, height});
  const int boards = 3 + random.below(4);
  const double step = (height - 0.08) / boards;
  for (int board = 0; board <= boards; ++board) {
    const double z = 0.06 + step * board;
    add_box(shelf.mesh, Vector3d(0, 0, z), {2 * x - 0.04, 2 * y, 0.024});
    if (board == boards) break;
    for (double at = -x + 0.04; at < x - 0.08;) {  // rows of binders and boxes with gaps
      const double width = random.uniform(0.04, 0.3), tall = random.uniform(0.35, 0.9) * step;
      if (at + width < x - 0.03 && random.chance(0.65))
        add_box(shelf.mesh, Vector3d(at + 0.5 * width, random.uniform(-0.05, 0.03), z + 0.012 + 0.5 * tall),
                {width, random.uniform(0.9, 1.6) * y, tall},
                random.chance(0.15) ? Material::dark : Material::matte);
      at += width + random.uniform(0, 0.05);
    }
  }
  return shelf;
}

Furniture make_cabinet(Random& random) {
  Furniture cabinet{{}, {random.uniform(0.35, 0.7), random.uniform(0.2, 0.32)}, false};
  const double x = cabinet.half_size.x(), y = cabinet.half_size.y(), height = random.uniform(0.7, 2.0);
  add_box(cabinet.mesh, Vector3d(0, 0.01, 0.5 * height), {2 * x, 2 * y - 0.02, height});
  const int doors = 1 + random.below(3);
  for (int i = 0; i < doors; ++i) {  // doors stand proud of the body
    const double width = 2 * x / doors;
    add_box(cabinet.mesh, Vector3d(-x + (i + 0.5) * width, -y, 0.5 * height),
            {width - 0.03, 0.03, height - 0.08});
  }
  add_clutter(cabinet.mesh, random, x - 0.15, y - 0.1, height, random.below(4));
  return cabinet;
}

Furniture make_plant(Random& random) {
  const double radius = random.uniform(0.14, 0.24), height = random.uniform(0.25, 0.4);
  Furniture plant{{}, {radius + 0.08, radius + 0.08}, false};
  add_cylinder(plant.mesh, {0, 0, 0}, 0.8 * radius, radius, height, 12);
  for (int i = 0, clumps = 3 + random.below(5); i < clumps; ++i) {
    const Vector3d at(random.uniform(-0.2, 0.2), random.uniform(-0.2, 0.2), height + random.uniform(0.15, 0.9));
    const Vector3d radii(random.uniform(0.08, 0.24), random.uniform(0.08, 0.24), random.uniform(0.06, 0.2));
    add_ellipsoid(plant.mesh, at, radii, 5);
  }
  add_cylinder(plant.mesh, {0, 0, height}, 0.03, 0.02, 0.5, 6);
  return plant;
}

Furniture make_box(Random& random) {
  const Vector3d size(random.uniform(0.2, 0.6), random.uniform(0.2, 0.5), random.uniform(0.15, 0.5));
  Furniture box{{}, {0.5 * size.x(), 0.5 * size.y()}, true};
  add_box(box.mesh, Vector3d(0, 0, 0.5 * size.z()), size);
  if (random.chance(0.4)) {  // a smaller one on top, tilted as if leaning on something
    const Vector3d top = 0.7 * size;
    Pose T = upright({0, 0, size.z() + 0.55 * top.z()}, random.uniform(-1, 1));
    T.rotate(Eigen::AngleAxisd(random.uniform(-0.2, 0.2), Vector3d::UnitX()));
    add_box(box.mesh, T, top);
  }
  return box;
}

Furniture make_pillar(Random& random, double height_m) {
  const double half = random.uniform(0.15, 0.28);
  Furniture pillar{{}, {half, half}, false};
  if (random.chance(0.5))
    add_cylinder(pillar.mesh, {0, 0, 0}, half, half, height_m, 20);
  else
    add_box(pillar.mesh, Vector3d(0, 0, 0.5 * height_m), {2 * half, 2 * half, height_m});
  return pillar;
}

Furniture make_partition(Random& random) {
  Furniture partition{{}, {random.uniform(0.8, 1.8), 0.05}, false};
  const double height = random.uniform(1.3, 1.9);
  add_box(partition.mesh, Vector3d(0, 0, 0.5 * height), {2 * partition.half_size.x(), 0.06, height});
  for (const double side : {-1.0, 1.0})
    add_box(partition.mesh, Vector3d(side * (partition.half_size.x() - 0.1), 0, 0.02), {0.05, 0.5, 0.04});
  return partition;
}

}  // namespace liloc::sim
