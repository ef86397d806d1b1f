#pragma once
// How much of a device's view the ceiling sees, and how likely a single request from there is verified.
#include "server/plan/device_views.hpp"

namespace liloc::plan {

/// What the surfaces that a device and the ceiling both see tell of a pose. Each counts once.
struct Support {
  double covered = 0;             ///< how many the ceiling sees too
  double upright = 0;             ///< of those, on walls and sides of furniture
  double xx = 0, xy = 0, yy = 0;  ///< sum of n * n^T of the normals' horizontal parts

  void add(const Eigen::Vector3f& normal_map, double sign = 1);
  /// The weaker direction in which walls and sides hold a pose: how many of them face it.
  [[nodiscard]] double weakest() const;
};

/// What the prediction rests on.
struct ViewFeatures {
  double seen = 0;   ///< surfaces that the device sees
  Support support;   ///< of them
  double alike = 0;  ///< Twin::alike; told beside, as it does not tell verified from unverified
};

/// Probability that a request from this pose, answered on its own, is verified. More support never lowers it.
[[nodiscard]] double chance_verified(const ViewFeatures& features);

}  // namespace liloc::plan
