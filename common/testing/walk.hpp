#pragma once
// A walk through a box room, as a device sees it.
#include <cmath>

#include "common/testing/box_room.hpp"

namespace liloc::test {

constexpr StampNs kStart = 1'700'000'000'000'000'000;
constexpr double kFrameHz = 15, kStillS = 1.0;

/// Still for a second, then walks about and turns.
inline Pose walk(double t) {
  const double s = std::max(0.0, t - kStillS), ramp = s * s / (s + 0.5);
  return scene::looking({3 + 0.9 * std::sin(0.7 * ramp), 2.5 + 0.7 * std::sin(0.9 * ramp), 1.2}, 0.6 * ramp,
                        0.2);
}

inline Pose mounting() {
  Pose T = Pose::Identity();
  T.linear() = Eigen::Quaterniond(-0.5, 0.5, -0.5, 0.5).toRotationMatrix();
  T.translation() = Eigen::Vector3d(0.01, 0.0, 0.005);
  return T;
}

inline double time_of(int frame) {
  return 0.05 + frame / kFrameHz;
}
inline StampNs stamp_of(int frame) {
  return kStart + from_seconds(time_of(frame));
}

inline DepthImage frame_at(const scene::BoxRoom& room, int frame, double noise_m = 0.004) {
  return scene::render(room, walk(time_of(frame)), scene::small_camera(), stamp_of(frame), noise_m);
}

/// A hand before the lens.
inline DepthImage covered_at(int frame) {
  DepthImage image;
  image.stamp_ns = stamp_of(frame);
  image.width = 160;
  image.height = 120;
  image.units.assign(160 * 120, 400);
  return image;
}

}  // namespace liloc::test
