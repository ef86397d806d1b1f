#pragma once
// A pose whose numbers are all different, for the tests of messages.
#include "common/geometry/pose.hpp"

namespace liloc::wire {

inline Pose sample_pose(double s) {
  Pose T = Pose::Identity();
  T.linear() = Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5).toRotationMatrix();
  T.translation() = Eigen::Vector3d(s, 2 * s, -s);
  return T;
}

}  // namespace liloc::wire
