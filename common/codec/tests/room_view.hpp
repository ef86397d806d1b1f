#pragma once
#include <cmath>
#include <limits>
#include <random>

#include "common/geometry/voxel.hpp"

namespace liloc {

// What a sensor sees of a furnished room 6 m long: floor, two walls, a desk, a shelf; 4 mm noise; 0.05 m
// voxels.
inline Cloud room_view(unsigned seed, int samples = 20'000) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  std::normal_distribution<float> noise(0, 0.004F);
  Cloud cloud;
  for (int i = 0; i < samples; ++i) {
    const float a = 6 * unit(random), b = 2 * unit(random), n = noise(random);
    switch (i % 5) {
      case 0:
        cloud.points.emplace_back(a / 2 - 1.5F, 1.5F + n, 3 * b);
        break;
      case 1:
        cloud.points.emplace_back(a / 2 - 1.5F, b - 0.5F, 6 + n);
        break;
      case 2:
        cloud.points.emplace_back(-1.5F + n, b - 0.5F, a);
        break;
      case 3:
        cloud.points.emplace_back(1 + a / 5, 0.6F + n, 3 + b / 3);
        break;
      default:
        cloud.points.emplace_back(-1 + a / 8, -0.5F + b / 2, 4 + n);
    }
  }
  return voxel_downsample(cloud, 0.05);
}

/// Of every fifth point, which is enough to tell.
inline double rmse_m(const Cloud& from, const Cloud& to) {
  constexpr std::size_t kEvery = 5;
  double sum = 0;
  for (std::size_t i = 0; i < from.size(); i += kEvery) {
    const auto& p = from.points[i];
    float best = std::numeric_limits<float>::max();
    for (const auto& q : to.points) best = std::min(best, (p - q).squaredNorm());
    sum += static_cast<double>(best);
  }
  return std::sqrt(sum / static_cast<double>((from.size() + kEvery - 1) / kEvery));
}

}  // namespace liloc
