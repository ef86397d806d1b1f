#include "common/registration/normals.hpp"

#include <Eigen/Eigenvalues>

#include "common/registration/neighbors.hpp"

namespace liloc {

Cloud with_normals(const Cloud& cloud, const Eigen::Vector3f& sensor_position, const NormalOptions& options) {
  const RadiusSearch search(cloud.points, options.radius_m);
  Cloud result;
  result.points.reserve(cloud.size());
  result.normals.reserve(cloud.size());
  for (const Eigen::Vector3f& p : cloud.points) {
    if (!p.allFinite()) continue;
    int count = 0;
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
    search.for_each(p, [&](std::uint32_t i, float) {
      const Eigen::Vector3f d = cloud.points[i] - p;  // relative: single precision loses nothing
      sum += d;
      squares += d * d.transpose();
      ++count;
    });
    if (count < options.min_neighbors) continue;
    const auto n = static_cast<float>(count);
    const Eigen::Matrix3f covariance = squares / n - (sum / n) * (sum / n).transpose();
    Eigen::SelfAdjointEigenSolver<Eigen::Matrix3f> eigen;
    eigen.computeDirect(covariance);
    Eigen::Vector3f normal = eigen.eigenvectors().col(0);
    if (normal.dot(sensor_position - p) < 0) normal = -normal;
    result.points.push_back(p);
    result.normals.push_back(normal.stableNormalized());
  }
  return result;
}

}  // namespace liloc
