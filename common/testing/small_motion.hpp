#pragma once
// A motion in a seeded direction.
#include <random>

#include "common/geometry/pose.hpp"

namespace liloc {

inline Pose small_motion(unsigned seed, double angle_rad, double shift_m) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> unit(0, 1);
  Vector6d a;
  for (int i = 0; i < 6; ++i) a[i] = unit(rng);
  a.head<3>() *= angle_rad / a.head<3>().norm();
  a.tail<3>() *= shift_m / a.tail<3>().norm();
  return increment(a);
}

}  // namespace liloc
