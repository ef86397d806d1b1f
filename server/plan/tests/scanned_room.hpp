#pragma once
// Scans of simple rooms: boxes whose faces are points.
#include "common/testing/box_room.hpp"
#include "server/plan/device_views.hpp"

namespace liloc::plan::test {

/// Points 4 cm apart on the six faces of a box; the low corner and the high one.
inline void add_box(Cloud& scan, const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  constexpr double kStep_m = 0.04;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const double side : {low[axis], high[axis]})
      for (double a = low[u]; a <= high[u]; a += kStep_m)
        for (double b = low[v]; b <= high[v]; b += kStep_m) {
          Eigen::Vector3d p;
          p[axis] = side;
          p[u] = a;
          p[v] = b;
          scan.points.push_back(p.cast<float>());
        }
  }
}

/// 8 x 6 x 3 m, with a table, a cupboard and a wall across that leaves a door of 1 m at y = 0..1.
inline Cloud scan_of_two_rooms() {
  Cloud scan;
  add_box(scan, {0, 0, 0}, {8, 6, 3});
  add_box(scan, {1, 2, 0}, {2.2, 3, 0.75});
  add_box(scan, {6.5, 4, 0}, {7.5, 4.6, 1.9});
  add_box(scan, {4.4, 1, 0}, {4.6, 6, 3});
  return scan;
}

inline DeviceModel small_device() {
  DeviceModel device;
  device.camera = scene::small_camera();
  return device;
}

inline FloorOptions few_places() {
  FloorOptions options;
  options.most_places = 25;
  return options;
}

}  // namespace liloc::plan::test
