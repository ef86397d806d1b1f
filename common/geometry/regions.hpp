#pragma once
// Parts of a site that lie far apart, so that what is kept of them need not cover what lies between.
#include <Eigen/Geometry>
#include <vector>

namespace liloc {

using Region = Eigen::AlignedBox2d;  ///< over the map's x and y, in metres, at any height

/// Boxes, merged until each lies at least `apart_m` from all others along x or y; by rising x, then y. Empty
/// ones are left out.
[[nodiscard]] std::vector<Region> merged(std::vector<Region> boxes, double apart_m);

/// The regions that hold all finite points: one where nothing lies so far apart, or where points lie scattered
/// over more than some hundred places; none without points.
[[nodiscard]] std::vector<Region> regions_of(const std::vector<Eigen::Vector3f>& points, double apart_m);

/// Surfaces so far apart are none that a device sees at once: over twice `DepthOptions::max_range_m`.
inline constexpr double kFarApart_m = 20;

/// Whether it holds a point; none that is not finite.
[[nodiscard]] inline bool holds(const Region& region, const Eigen::Vector3f& p) {
  return p.allFinite() && region.contains(p.head<2>().cast<double>());
}

/// Of anywhere.
[[nodiscard]] Region everywhere();

}  // namespace liloc
