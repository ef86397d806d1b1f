#pragma once
// A room's cloud a moment later.
#include <random>

#include "common/geometry/cloud.hpp"

namespace liloc {

/// Takes points away here, moves some there, adds others, and lets two change places.
inline Cloud changed(const Cloud& cloud, std::mt19937_64& rng) {
  std::uniform_real_distribution<float> unit(-1, 1);
  const auto near = [&] { return cloud.points[rng() % cloud.size()]; };
  const Eigen::Vector3f gone = near(), moved = near(), fresh = near();
  Cloud now;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if ((cloud.points[i] - gone).norm() < 0.4F) continue;
    const bool moves = (cloud.points[i] - moved).norm() < 0.3F;
    now.points.emplace_back(cloud.points[i] + (moves ? 0.03F : 0.0F) * cloud.normals[i]);
    now.normals.push_back(cloud.normals[i]);
    if (i % 97 != 0) continue;
    now.points.emplace_back(fresh + 0.3F * Eigen::Vector3f(unit(rng), unit(rng), unit(rng)));
    now.normals.push_back(Eigen::Vector3f(unit(rng), unit(rng), unit(rng)).normalized());
  }
  const std::size_t i = rng() % now.size(), k = rng() % now.size();
  std::swap(now.points[i], now.points[k]);
  std::swap(now.normals[i], now.normals[k]);
  return now;
}

}  // namespace liloc
