#include "server/survey/reference.hpp"

#include <algorithm>
#include <utility>

#include "common/base/quantile.hpp"
#include "common/geometry/voxel.hpp"
#include "common/registration/points/normals.hpp"

namespace liloc::survey {
namespace {

constexpr std::size_t kFewestPoints = 500;             // by hand
constexpr double kSmallest_m = 0.5, kLargest_m = 500;  // a room in metres; in millimetres it is 4000 long
constexpr double kReach_m = 0.3;                       // of the widest pairs of a refinement

/// Between the 2nd and 98th hundredth along the longest axis: a few stray points do not make a room large.
double extent_m(const Cloud& cloud) {
  double longest = 0;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> values;
    for (const Eigen::Vector3f& p : cloud.points)
      if (p.allFinite()) values.push_back(p[axis]);
    if (values.empty()) return 0;
    std::ranges::sort(values);
    const std::size_t cut = values.size() / 50;
    longest = std::max(longest, static_cast<double>(values[values.size() - 1 - cut] - values[cut]));
  }
  return longest;
}

}  // namespace

Reference::Reference(Cloud cloud_map, double voxel_size_m)
    : cloud_(std::move(cloud_map)), nearest_(cloud_.points, voxel_size_m, kReach_m) {}

Result<Reference> Reference::create(const Cloud& scan_map, double voxel_size_m) {
  const double extent = extent_m(scan_map);
  if (!(extent >= kSmallest_m && extent <= kLargest_m))
    return fail("the scan spans {:.3g} m, of {} to {}; is it in metres?", extent, kSmallest_m, kLargest_m);
  Cloud thin =
      with_normals(voxel_downsample(scan_map, voxel_size_m), Eigen::Vector3f::Zero(), {2.5 * voxel_size_m, 6});
  if (thin.size() < kFewestPoints)
    return fail("the scan has {} points on surfaces at a voxel of {} m, of at least {}; give a denser one",
                thin.size(), voxel_size_m, kFewestPoints);
  return Reference(std::move(thin), voxel_size_m);
}

Cloud Reference::facing(const Eigen::Vector3f& position_map) const {
  Cloud turned = cloud_;
  for (std::size_t i = 0; i < turned.size(); ++i)
    if (turned.normals[i].dot(position_map - turned.points[i]) < 0) turned.normals[i] = -turned.normals[i];
  return turned;
}

Eigen::Vector3f Reference::middle_map() const {
  Eigen::Vector3f middle;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<float> values;
    for (const Eigen::Vector3f& p : cloud_.points) values.push_back(p[axis]);
    middle[axis] = static_cast<float>(median(std::move(values)));
  }
  return middle;
}

}  // namespace liloc::survey
