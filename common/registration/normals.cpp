#include "common/registration/normals.hpp"

#include <Eigen/Eigenvalues>
#include <array>

#include "common/registration/neighbors.hpp"
#include "common/registration/simd.hpp"

namespace liloc {
namespace {

/// Count, sums and sums of products of the offsets from `p` within the radius. Relative to `p`, single
/// precision loses nothing.
LILOC_WIDE std::array<float, 10> moments(const float* xs, const float* ys, const float* zs, int count, float px,
                                         float py, float pz, float squared_radius) {
  float n = 0, sx = 0, sy = 0, sz = 0, xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;
#pragma omp simd reduction(+ : n, sx, sy, sz, xx, xy, xz, yy, yz, zz)
  for (int i = 0; i < count; ++i) {
    const float dx = xs[i] - px, dy = ys[i] - py, dz = zs[i] - pz;
    const float inside = dx * dx + dy * dy + dz * dz <= squared_radius ? 1.0F : 0.0F;
    const float wx = inside * dx, wy = inside * dy, wz = inside * dz;
    n += inside;
    sx += wx;
    sy += wy;
    sz += wz;
    xx += wx * dx;
    xy += wx * dy;
    xz += wx * dz;
    yy += wy * dy;
    yz += wy * dz;
    zz += wz * dz;
  }
  return {n, sx, sy, sz, xx, xy, xz, yy, yz, zz};
}

Eigen::Vector3f thinnest_direction(const std::array<float, 10>& m) {
  const Eigen::Vector3f mean = Eigen::Vector3f(m[1], m[2], m[3]) / m[0];
  Eigen::Matrix3f squares;
  squares << m[4], m[5], m[6], m[5], m[7], m[8], m[6], m[8], m[9];
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> eigen;
  eigen.computeDirect(squares / m[0] - mean * mean.transpose());
  return eigen.eigenvectors().col(0);
}

}  // namespace

Cloud with_normals(const Cloud& cloud, const Eigen::Vector3f& sensor_position, const NormalOptions& options) {
  const RadiusSearch search(cloud.points, options.radius_m);
  const float squared_radius = search.radius_m() * search.radius_m();
  std::vector<Eigen::Vector3f> normals(cloud.size(), Eigen::Vector3f::Zero());
  search.for_each_cell([&](std::span<const std::uint32_t> own, const RadiusSearch::Points& nearby) {
    for (const std::uint32_t i : own) {
      const Eigen::Vector3f& p = cloud.points[i];
      const auto m = moments(nearby.x.data(), nearby.y.data(), nearby.z.data(),
                             static_cast<int>(nearby.x.size()), p.x(), p.y(), p.z(), squared_radius);
      if (m[0] < static_cast<float>(options.min_neighbors)) continue;
      const Eigen::Vector3f normal = thinnest_direction(m).stableNormalized();
      normals[i] = normal.dot(sensor_position - p) < 0 ? Eigen::Vector3f(-normal) : normal;
    }
  });
  Cloud result;
  result.points.reserve(cloud.size());
  result.normals.reserve(cloud.size());
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if (normals[i].isZero()) continue;
    result.points.push_back(cloud.points[i]);
    result.normals.push_back(normals[i]);
  }
  return result;
}

}  // namespace liloc
