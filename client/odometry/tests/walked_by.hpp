#pragma once
// A device in the middle of a room, and somebody who walks by.
#include <cmath>

#include "common/testing/walk.hpp"

namespace liloc::test {

constexpr double kNoiseM = 0.006;

inline DepthImage view(const scene::BoxRoom& room, const Pose& T, int frame) {
  return scene::render(room, T, scene::small_camera(), stamp_of(frame), kNoiseM);
}

/// Somebody who walks across the view, 1.5 m before the device, at 0.6 m/s.
inline scene::BoxRoom with_walker(scene::BoxRoom room, double t) {
  const Eigen::Vector3d ahead(std::cos(0.6), std::sin(0.6), 0), left(-std::sin(0.6), std::cos(0.6), 0);
  const Eigen::Vector3d at = Eigen::Vector3d(3, 2.5, 0) + 1.5 * ahead + (0.6 * t - 1.5) * left;
  room.furniture.push_back({at + Eigen::Vector3d(-0.25, -0.25, 0), at + Eigen::Vector3d(0.25, 0.25, 1.75)});
  return room;
}

}  // namespace liloc::test
