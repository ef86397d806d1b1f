#pragma once
#include <cmath>
#include <random>

#include "common/geometry/voxel.hpp"

namespace liloc {

/// A wavy sheet with noise: curved enough that every normal differs.
inline Cloud wavy_sheet(unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<float> unit(-1, 1);
  std::normal_distribution<float> noise(0, 0.002F);
  Cloud cloud;
  for (int i = 0; i < 4000; ++i) {
    const float x = unit(rng), y = unit(rng);
    cloud.points.emplace_back(x, y, 0.2F * std::sin(3 * x) * std::cos(2 * y) + noise(rng));
  }
  return voxel_downsample(cloud, 0.05);
}

}  // namespace liloc
