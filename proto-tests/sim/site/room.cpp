#include "proto-tests/sim/site/room.hpp"

#include <algorithm>
#include <numbers>
#include <vector>

namespace liloc::sim {
namespace {

using Eigen::Vector3d;

struct Opening {
  double from = 0, to = 0, bottom = 0, top = 0, recess = 0.15;
  bool window = false;
};

/// A wall's own frame: x along it, y out of the room, z up.
void add_opening(Mesh& mesh, const Pose& T_map_wall, const Opening& o) {
  const Eigen::Matrix3d R = T_map_wall.linear();
  const Vector3d along = R.col(0) * (o.to - o.from), out = R.col(1) * o.recess,
                 up = R.col(2) * (o.top - o.bottom);
  const Vector3d corner = T_map_wall * Vector3d(o.from, 0, o.bottom);
  add_quad(mesh, corner, along, out);
  add_quad(mesh, corner + up, along, out);
  add_quad(mesh, corner, up, out);
  add_quad(mesh, corner + along, up, out);
  add_quad(mesh, corner + out, along, up, o.window ? Material::glass : Material::matte);
  const double middle = 0.5 * (o.from + o.to), width = o.to - o.from;
  const auto put = [&](const Vector3d& centre, const Vector3d& size) {
    add_box(mesh, T_map_wall * upright(centre, 0), size);
  };
  for (const double x : {o.from - 0.03, o.to + 0.03})  // the frame stands proud of the wall
    put({x, -0.01, 0.5 * (o.bottom + o.top)}, {0.06, 0.06, o.top - o.bottom + 0.12});
  put({middle, -0.01, o.top + 0.03}, {width + 0.12, 0.06, 0.06});
  if (!o.window) return;
  put({middle, -0.04, o.bottom - 0.02}, {width + 0.2, 0.2, 0.04});  // sill
  put({middle, o.recess - 0.02, 0.5 * (o.bottom + o.top)}, {0.06, 0.05, o.top - o.bottom});
  put({middle, -0.07, 0.42}, {0.8 * width, 0.1, 0.55});  // radiator
}

void add_wall(Mesh& mesh, const Pose& T_map_wall, double length, double height,
              const std::vector<Opening>& openings) {
  const Eigen::Matrix3d R = T_map_wall.linear();
  const auto panel = [&](double x0, double x1, double z0, double z1) {
    if (x1 > x0 && z1 > z0)
      add_quad(mesh, T_map_wall * Vector3d(x0, 0, z0), R.col(0) * (x1 - x0), R.col(2) * (z1 - z0));
  };
  double done = 0;
  for (const Opening& o : openings) {
    panel(done, o.from, 0, height);
    panel(o.from, o.to, 0, o.bottom);
    panel(o.from, o.to, o.top, height);
    add_opening(mesh, T_map_wall, o);
    done = o.to;
  }
  panel(done, length, 0, height);
}

std::vector<Opening> random_openings(Random& random, double length, double height) {
  std::vector<Opening> openings;
  const bool windows = random.chance(0.5);  // a wall to the outside has windows, the others doors
  double at = random.uniform(0.4, 1.6);
  while (at < length - 1.6) {
    Opening o;
    o.window = windows;
    o.from = at;
    o.to = at + (windows ? random.uniform(0.9, 1.6) : random.uniform(0.85, 1.1));
    o.bottom = windows ? random.uniform(0.8, 1.0) : 0;
    o.top = std::min(height - 0.3, windows ? o.bottom + random.uniform(1.0, 1.6) : random.uniform(2.0, 2.15));
    o.recess = random.uniform(0.08, 0.25);
    if (o.to > length - 0.3) break;
    openings.push_back(o);
    at = o.to + random.uniform(windows ? 0.5 : 1.2, windows ? 1.5 : 4.0);
  }
  return openings;
}

/// Wide openings with a room's part behind, high or low, between stretches of plain wall.
std::vector<Opening> random_niches(Random& random, double length, double height) {
  std::vector<Opening> openings;
  double at = random.uniform(0.5, 3.0);
  while (at < length - 1.6) {
    Opening o;
    o.from = at;
    o.to = std::min(at + random.uniform(0.9, 4.5), length - 0.4);
    o.bottom = random.chance(0.4) ? random.uniform(0.9, 1.2) : 0;
    o.top = std::min(height - 0.2, random.uniform(2.0, 2.9));
    o.recess = random.uniform(0.1, 2.5);
    o.window = random.chance(0.2);
    openings.push_back(o);
    at = o.to + random.uniform(1.0, 5.0);
  }
  return openings;
}

void add_lamps(Mesh& mesh, Random& random, const Vector3d& size, bool symmetric) {
  const int lamps = std::max(2, static_cast<int>(size.x() * size.y() / 10));
  for (int i = 0; i < lamps; ++i) {
    const Vector3d at(random.uniform(0.8, size.x() - 0.8), random.uniform(0.6, size.y() - 0.6),
                      size.z() - 0.06);
    const double yaw = random.chance(0.5) ? 0 : 0.5 * std::numbers::pi;
    const Vector3d lamp(random.uniform(0.6, 1.4), random.uniform(0.15, 0.6), 0.1);
    add_box(mesh, upright(at, yaw), lamp);
    if (symmetric) add_box(mesh, upright({size.x() - at.x(), size.y() - at.y(), at.z()}, yaw), lamp);
  }
}

}  // namespace

Mesh make_room(Random& random, const Vector3d& size, const RoomStyle& style) {
  Mesh mesh;
  const Vector3d x(size.x(), 0, 0), y(0, size.y(), 0), z(0, 0, size.z());
  add_quad(mesh, Vector3d::Zero(), x, y, style.floor);
  add_quad(mesh, z, x, y);
  std::vector<Opening> openings[4];
  for (int side = 0; side < 4; ++side) {
    const double length = side % 2 == 0 ? size.x() : size.y();
    if (style.symmetric && side >= 2)
      openings[side] = openings[side - 2];
    else if (style.niches)
      openings[side] = random_niches(random, length, size.z());
    else
      openings[side] = random_openings(random, length, size.z());
  }
  const double quarter = 0.5 * std::numbers::pi;
  add_wall(mesh, upright({size.x(), 0, 0}, 2 * quarter), size.x(), size.z(), openings[0]);
  add_wall(mesh, upright({size.x(), size.y(), 0}, 3 * quarter), size.y(), size.z(), openings[1]);
  add_wall(mesh, upright({0, size.y(), 0}, 0), size.x(), size.z(), openings[2]);
  add_wall(mesh, upright({0, 0, 0}, quarter), size.y(), size.z(), openings[3]);
  add_lamps(mesh, random, size, style.symmetric);
  return mesh;
}

}  // namespace liloc::sim
