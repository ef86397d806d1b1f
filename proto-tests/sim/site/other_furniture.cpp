#include "proto-tests/sim/site/other_furniture.hpp"

#include <algorithm>
#include <numbers>

namespace liloc::sim {
namespace {

using Eigen::Vector3d;

Material some_material(Random& random) {
  return random.chance(0.25) ? Material::dark : Material::matte;
}

/// A bar between two points, square in section.
void add_bar(Mesh& mesh, const Vector3d& from, const Vector3d& to, double thick_m, Material material) {
  Pose T = Pose::Identity();
  T.linear() = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), to - from).toRotationMatrix();
  T.translation() = 0.5 * (from + to);
  add_box(mesh, T, {thick_m, thick_m, (to - from).norm()}, material);
}

}  // namespace

Furniture make_sofa(Random& random) {
  const int seats = 1 + random.below(3);
  const double x = 0.2 + 0.33 * seats, y = random.uniform(0.38, 0.5), seat = random.uniform(0.36, 0.46);
  const Material cloth = some_material(random);
  Furniture sofa{{}, {x, y}, seats == 1};
  add_box(sofa.mesh, Vector3d(0, 0, 0.5 * seat), {2 * x - 0.2, 2 * y - 0.1, seat - 0.08}, cloth);
  for (const double side : {-1.0, 1.0})
    add_ellipsoid(sofa.mesh, {side * (x - 0.1), 0, 0.75 * seat}, {0.12, y, seat}, 7, cloth);
  for (int i = 0; i < seats; ++i) {
    const double at = (i - 0.5 * (seats - 1)) * 0.64;
    add_ellipsoid(sofa.mesh, {at, -0.05, seat + 0.03}, {0.33, y - 0.08, random.uniform(0.06, 0.12)}, 6, cloth);
    add_ellipsoid(sofa.mesh, {at, y - 0.14, seat + 0.27}, {0.34, 0.15, random.uniform(0.22, 0.34)}, 6, cloth);
  }
  return sofa;
}

Furniture make_round_table(Random& random) {
  const double radius = random.uniform(0.3, 0.8);
  const double top = random.chance(0.3) ? random.uniform(1.0, 1.12) : random.uniform(0.4, 0.76);
  Furniture table{{}, {radius, radius}, radius < 0.45};
  add_cylinder(table.mesh, {0, 0, 0}, 0.5 * radius, 0.4 * radius, 0.03, 16);
  add_cylinder(table.mesh, {0, 0, 0.03}, 0.05, 0.04, top - 0.05, 8, Material::dark);
  add_cylinder(table.mesh, {0, 0, top - 0.03}, radius, radius, 0.03, 24);
  for (int i = random.below(6); i > 0; --i) {
    const double at = random.uniform(0, 2 * std::numbers::pi), off = random.uniform(0, radius - 0.1);
    const double size = random.uniform(0.03, 0.1);
    add_cylinder(table.mesh, {off * std::cos(at), off * std::sin(at), top}, size,
                 random.uniform(0.5, 1.2) * size, random.uniform(0.05, 0.3), 8, some_material(random));
  }
  return table;
}

Furniture make_stool(Random& random) {
  const double radius = random.uniform(0.15, 0.22), seat = random.uniform(0.4, 0.8);
  Furniture stool{{}, {radius, radius}, true};
  add_cylinder(stool.mesh, {0, 0, 0}, radius, 0.8 * radius, 0.03, 12, Material::dark);
  add_cylinder(stool.mesh, {0, 0, 0.03}, 0.025, 0.025, seat - 0.05, 6);
  add_cylinder(stool.mesh, {0, 0, seat - 0.05}, radius, radius, 0.07, 14, some_material(random));
  return stool;
}

Furniture make_pole(Random& random) {
  const double height = random.uniform(1.3, 2.1), foot = random.uniform(0.14, 0.24);
  Furniture pole{{}, {foot, foot}, true};
  for (int i = 0; i < 3; ++i) {
    const double at = 2 * std::numbers::pi * i / 3;
    add_bar(pole.mesh, {0, 0, 0.12}, {foot * std::cos(at), foot * std::sin(at), 0.01}, 0.025, Material::dark);
  }
  add_cylinder(pole.mesh, {0, 0, 0.1}, 0.018, 0.018, height - 0.1, 6);
  if (random.chance(0.5))  // a lamp's shade
    add_cylinder(pole.mesh, {0, 0, height - 0.25}, random.uniform(0.18, 0.28), 0.12, 0.3, 14);
  else  // coats
    for (int i = 1 + random.below(3); i > 0; --i)
      add_ellipsoid(pole.mesh, {random.uniform(-0.12, 0.12), random.uniform(-0.12, 0.12), height - 0.5},
                    {0.13, 0.1, random.uniform(0.3, 0.5)}, 5, some_material(random));
  return pole;
}

Furniture make_whiteboard(Random& random) {
  const double x = random.uniform(0.5, 1.0), tall = random.uniform(0.8, 1.2), low = random.uniform(0.7, 0.95);
  Furniture board{{}, {x, 0.3}, true};
  Pose T = upright({0, 0, low + 0.5 * tall}, 0);
  T.rotate(Eigen::AngleAxisd(random.uniform(-0.12, 0.12), Vector3d::UnitX()));
  add_box(board.mesh, T, {2 * x - 0.08, 0.025, tall});
  for (const double side : {-1.0, 1.0}) {
    add_bar(board.mesh, {side * (x - 0.03), 0, 0.05}, {side * (x - 0.03), 0, low + tall}, 0.03,
            Material::matte);
    add_box(board.mesh, Vector3d(side * (x - 0.03), 0, 0.04), {0.04, 0.58, 0.04});
  }
  return board;
}

Furniture make_door_leaf(Random& random) {
  const double width = random.uniform(0.8, 0.95), open_rad = random.uniform(0.3, 1.5);
  const double half = 0.5 * std::max(width * std::cos(open_rad), 0.1), deep = 0.5 * width * std::sin(open_rad);
  Furniture door{{}, {half, deep + 0.03}, false};
  const Pose T = upright({-half, deep, 0}, -open_rad) * upright({0.5 * width, 0, 0}, 0);
  add_box(door.mesh, T * upright({0, 0, 1.02}, 0), {width, 0.04, 2.02}, some_material(random));
  add_box(door.mesh, T * upright({0.5 * width - 0.08, 0, 1.05}, 0), {0.12, 0.14, 0.02});
  return door;
}

Furniture make_pallet_rack(Random& random, double height_m) {
  const double x = random.uniform(0.9, 1.5), y = random.uniform(0.4, 0.55);
  const int levels = std::max(2, static_cast<int>((height_m - 0.4) / random.uniform(1.0, 1.5)));
  const double step = random.uniform(0.9, 1.3);
  Furniture rack{{}, {x, y}, false};
  for (const double side_x : {-1.0, 1.0})
    for (const double side_y : {-1.0, 1.0})
      add_bar(rack.mesh, {side_x * (x - 0.04), side_y * (y - 0.04), 0},
              {side_x * (x - 0.04), side_y * (y - 0.04), std::min(levels * step + 0.3, height_m - 0.3)}, 0.08,
              Material::matte);
  for (int level = 0; level < levels && level * step < height_m - 0.6; ++level) {
    const double z = 0.1 + level * step;
    for (const double side : {-1.0, 1.0})
      add_box(rack.mesh, Vector3d(0, side * (y - 0.03), z), {2 * x, 0.05, 0.1});
    for (double at = -x + 0.1; at < x - 0.4;) {
      const double width = random.uniform(0.3, 0.9);
      Vector3d size(width, random.uniform(0.9, 1.8) * y, random.uniform(0.2, 0.8) * step);
      size.z() = std::min(size.z(), height_m - 0.05 - z);
      if (at + width < x - 0.05 && random.chance(0.55))
        add_box(rack.mesh, Vector3d(at + 0.5 * width, 0, z + 0.05 + 0.5 * size.z()), size,
                some_material(random));
      at += width + random.uniform(0.02, 0.4);
    }
  }
  return rack;
}

Furniture make_machine(Random& random) {
  const double x = random.uniform(0.4, 1.0), y = random.uniform(0.35, 0.8), tall = random.uniform(0.8, 2.0);
  Furniture machine{{}, {x, y}, false};
  if (random.chance(0.5)) {
    const double radius = std::min(x, y) - 0.05;
    add_cylinder(machine.mesh, {0, 0, 0.15}, radius, radius, tall - 0.3, 20);
    add_ellipsoid(machine.mesh, {0, 0, tall - 0.15}, {radius, radius, 0.2}, 8);
  } else {
    add_box(machine.mesh, Vector3d(0, 0.1, 0.3 * tall), {2 * x - 0.05, 2 * y - 0.25, 0.6 * tall});
    add_box(machine.mesh, Vector3d(0.2 * x, 0.2, 0.75 * tall), {x, y, 0.5 * tall}, some_material(random));
    add_cylinder(machine.mesh, {-0.6 * x, -0.3 * y, 0.6 * tall}, 0.14, 0.1, 0.3, 10, Material::dark);
  }
  for (int i = random.below(4); i > 0; --i) {
    const double at = random.uniform(-x, x);
    add_bar(machine.mesh, {at, y - 0.05, 0.1}, {at + random.uniform(-0.2, 0.2), y - 0.05, tall + 0.4}, 0.06,
            Material::matte);
  }
  return machine;
}

Furniture make_trolley(Random& random) {
  const double x = random.uniform(0.35, 0.6), y = random.uniform(0.22, 0.32), tall = random.uniform(0.8, 1.6);
  Furniture trolley{{}, {x, y}, true};
  for (const double side_x : {-1.0, 1.0})
    for (const double side_y : {-1.0, 1.0})
      add_bar(trolley.mesh, {side_x * (x - 0.02), side_y * (y - 0.02), 0.02},
              {side_x * (x - 0.02), side_y * (y - 0.02), tall}, 0.03, Material::matte);
  for (int shelf = 0, shelves = 2 + random.below(3); shelf < shelves; ++shelf) {
    const double z = 0.15 + (tall - 0.2) * shelf / shelves;
    add_box(trolley.mesh, Vector3d(0, 0, z), {2 * x, 2 * y, 0.02});
    for (int i = random.below(3); i > 0; --i)
      add_cylinder(trolley.mesh, {random.uniform(-x + 0.12, x - 0.12), random.uniform(-0.08, 0.08), z},
                   random.uniform(0.05, 0.12), random.uniform(0.05, 0.12), random.uniform(0.1, 0.3), 9,
                   some_material(random));
  }
  return trolley;
}

Furniture make_column(Random& random, double height_m) {
  const double half = random.uniform(0.18, 0.4), plinth = half + random.uniform(0, 0.12);
  Furniture column{{}, {plinth, plinth}, false};
  add_box(column.mesh, Vector3d(0, 0, 0.1), {2 * plinth, 2 * plinth, 0.2});
  if (random.chance(0.6))
    add_cylinder(column.mesh, {0, 0, 0.2}, half, 0.85 * half, height_m - 0.2, 20);
  else
    add_box(column.mesh, Vector3d(0, 0, 0.5 * height_m), {2 * half, 1.4 * half, height_m});
  return column;
}

}  // namespace liloc::sim
