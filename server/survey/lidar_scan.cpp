#include "server/survey/lidar_scan.hpp"

#include <utility>

#include "common/geometry/depth.hpp"
#include "common/geometry/voxel.hpp"
#include "common/registration/points/normals.hpp"

namespace liloc::survey {
namespace {

constexpr std::size_t kFewestPoints = 500;  // by hand
constexpr double kNearest_m = 0.25;         // DepthOptions::min_range_m: no point is nearer

}  // namespace

Result<LidarScan> make_scan(GlobalLidar lidar, DepthImage surfaces, double voxel_size_m) {
  const auto all = depth_to_cloud(surfaces, lidar.camera);
  if (!all) return fail("{}: {}", lidar.id, all.error().message);
  Cloud thin =
      with_normals(voxel_downsample(*all, voxel_size_m), Eigen::Vector3f::Zero(), {2.5 * voxel_size_m, 6});
  if (thin.size() < kFewestPoints)
    return fail("{}: {} points on surfaces, of at least {}; is its view blocked, or its depth_scale wrong?",
                lidar.id, thin.size(), kFewestPoints);
  return LidarScan{std::move(lidar), std::move(surfaces), std::move(thin)};
}

Cloud corrected(const Cloud& cloud_sensor, const DepthError& error) {
  Cloud right = cloud_sensor;
  const auto scale = static_cast<float>(1 + error.scale);
  const auto bias = static_cast<float>(error.bias_m);
  for (Eigen::Vector3f& p : right.points) p *= scale + bias / std::max(p.z(), static_cast<float>(kNearest_m));
  return right;
}

}  // namespace liloc::survey
