#include "common/registration/refine/pose_covariance.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "common/registration/refine/pairs.hpp"

namespace liloc {
namespace {

struct Pair {
  std::uint64_t patch;
  Vector6d jacobian;
  double residual, weight;
  bool surroundings;
};

/// Points near each other on surfaces that face the same way.
std::uint64_t patch_of(const Eigen::Vector3f& p, const Eigen::Vector3f& normal, double patch_m) {
  int axis = 0;
  normal.cwiseAbs().maxCoeff(&axis);
  const auto side = static_cast<std::uint64_t>(2 * axis + (normal[axis] > 0 ? 1 : 0));
  std::uint64_t key = side;
  for (int i = 0; i < 3; ++i)
    key = key << 20 | (static_cast<std::uint64_t>(std::floor(p[i] / patch_m) + 512 * 1024) & 0xFFFFFU);
  return key;
}

std::vector<Pair> pairs_by_patch(const Target& target, const Query& query, const Pose& T,
                                 const CovarianceOptions& options) {
  std::vector<Pair> pairs;
  pairs.reserve(query.medium.size());
  const Eigen::Matrix3f R_source_target = T.linear().transpose().cast<float>();
  for_each_pair(fine_side(target, query.medium), T, options.max_pair_distance_m, options.min_normal_agreement,
                [&](std::size_t i, const Eigen::Vector3f&, const Eigen::Vector3f& normal,
                    const Eigen::Vector3f& offset, double weight) {
                  const Eigen::Vector3f& p = query.medium.points[i];
                  const Eigen::Vector3f n = R_source_target * normal;
                  pairs.push_back({patch_of(p, n, options.patch_m), jacobian_of(p, n),
                                   static_cast<double>(normal.dot(offset)), weight,
                                   !query.view.empty() && query.view.look_sensor(p, 0.05F) == Sight::unseen});
                });
  std::ranges::stable_sort(pairs, {}, &Pair::patch);
  return pairs;
}

/// Curvature of the cost by the points that the frame itself did not see.
Matrix6d curvature_of_surroundings(const std::vector<Pair>& pairs) {
  Matrix6d H = Matrix6d::Zero();
  for (const Pair& pair : pairs)
    if (pair.surroundings) H += pair.weight * pair.jacobian * pair.jacobian.transpose();
  return H;
}

/// The normal equations with one row per patch.
struct PatchSums {
  Matrix6d H = Matrix6d::Zero();      ///< curvature of the cost ...
  Matrix6d noise = Matrix6d::Zero();  ///< ... of which so much is expected of noisy normals alone
  Matrix6d M = Matrix6d::Zero();      ///< variance of its gradient
  int patches = 0;

  void add(const Pair* first, const Pair* last, double bias_m) {
    const auto count = static_cast<double>(last - first);
    Vector6d mean = Vector6d::Zero();
    double weight = 0, residual = 0, squared = 0;
    for (const Pair* p = first; p != last; ++p) {
      weight += p->weight;
      mean += p->weight * p->jacobian;
      residual += p->weight * p->residual;
      squared += p->weight * p->residual * p->residual;
    }
    mean /= weight;
    residual /= weight;
    H += weight * mean * mean.transpose();
    for (const Pair* p = first; p != last && count > 1; ++p) {
      const Vector6d off = p->jacobian - mean;
      noise += p->weight / (count - 1) * off * off.transpose();
    }
    const double scatter = std::max(squared / weight - residual * residual, 0.0) / count;
    M += weight * weight * (bias_m * bias_m + scatter + residual * residual) * mean * mean.transpose();
    ++patches;
  }
};

}  // namespace

Matrix6d pose_covariance(const Target& target, const Query& query, const Pose& T_target_source,
                         const CovarianceOptions& options) {
  Vector6d most;
  most << Eigen::Vector3d::Constant(options.most_rad), Eigen::Vector3d::Constant(options.most_m);
  const Matrix6d least_information = most.cwiseAbs2().cwiseInverse().asDiagonal();
  const std::vector<Pair> pairs = pairs_by_patch(target, query, T_target_source, options);
  PatchSums sums;
  for (std::size_t i = 0, end = 0; i < pairs.size(); i = end) {
    while (end < pairs.size() && pairs[end].patch == pairs[i].patch) ++end;
    sums.add(&pairs[i], pairs.data() + end, options.patch_bias_m);
  }
  if (sums.patches <= 6) return most.cwiseAbs2().asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(sums.H - sums.noise);
  const Matrix6d H_inverse = eigen.eigenvectors() *
                             eigen.eigenvalues().cwiseMax(1e-3).cwiseInverse().asDiagonal() *
                             eigen.eigenvectors().transpose();
  const double few = sums.patches / (sums.patches - 6.0);
  const Matrix6d H_around = curvature_of_surroundings(pairs);  // they are displaced together
  Vector6d around;
  around << Eigen::Vector3d::Constant(options.surroundings_sd_rad),
      Eigen::Vector3d::Constant(options.surroundings_sd_m);
  sums.M += H_around * around.cwiseAbs2().asDiagonal() * H_around;
  Matrix6d covariance = few * H_inverse * sums.M * H_inverse;
  covariance.diagonal().tail<3>().array() += options.common_bias_m * options.common_bias_m;
  covariance.diagonal().head<3>().array() += 1e-10;
  return (covariance.inverse() + least_information).inverse();
}

}  // namespace liloc
