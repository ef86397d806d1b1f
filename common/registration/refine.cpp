#include "common/registration/refine.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "common/registration/pairs.hpp"

namespace liloc {
namespace {

/// The normal equations of one iteration, taken about the source's origin so that they stay well conditioned.
struct Normals {
  Matrix6d H = Matrix6d::Zero();
  Vector6d g = Vector6d::Zero();
  double squared = 0, weight = 0;
  int pairs = 0;

  void add(const Vector6d& jacobian, double residual, double w) {
    const Vector6d weighted = w * jacobian;
    H.noalias() += weighted * jacobian.transpose();
    g.noalias() += weighted * residual;
    squared += w * residual * residual;
    weight += w;
    ++pairs;
  }
};

Normals accumulate(const Side& side, const Pose& T, double distance_m, const RefineOptions& options) {
  Normals sum;
  const bool to_plane = !options.point_to_point && side.source.has_normals() && side.target.has_normals();
  for_each_pair(side, T, distance_m, options.min_normal_agreement,
                [&](std::size_t, const Eigen::Vector3f& arm, const Eigen::Vector3f& normal,
                    const Eigen::Vector3f& offset, double weight) {
                  if (to_plane)
                    return sum.add(jacobian_of(arm, normal), static_cast<double>(normal.dot(offset)), weight);
                  for (int axis = 0; axis < 3; ++axis)
                    sum.add(jacobian_of(arm, Eigen::Vector3f::Unit(axis)), static_cast<double>(offset[axis]),
                            weight);
                });
  return sum;
}

/// Solves for the step, holding back directions that the pairs hardly observe.
Vector6d solve(const Normals& sum) {
  Matrix6d damped = sum.H;
  damped.diagonal().array() += 1e-4 * sum.weight + 1e-9;
  return -damped.ldlt().solve(sum.g);
}

Pose moved(const Pose& T, const Vector6d& step) {
  Pose result = T;
  result.linear() = so3_exp(step.head<3>()) * T.linear();
  result.translation() += step.tail<3>();
  return result;
}

/// Pulls towards the prior, in the same axes as the pairs: about the source's origin.
void add_prior(const PosePrior& prior, const Pose& T, Normals* sum) {
  const double variance = prior.residual_sd_m * prior.residual_sd_m;
  const double w_rotation = variance / (prior.sd_rad * prior.sd_rad),
               w_shift = variance / (prior.sd_m * prior.sd_m);
  const Eigen::Vector3d turn = so3_log(T.linear() * prior.T_target_source.linear().transpose());
  sum->H.topLeftCorner<3, 3>().diagonal().array() += w_rotation;
  sum->H.bottomRightCorner<3, 3>().diagonal().array() += w_shift;
  sum->g.head<3>() += w_rotation * turn;
  sum->g.tail<3>() += w_shift * (T.translation() - prior.T_target_source.translation());
}

/// Iterates with a distance that shrinks geometrically; true when the last step was small.
bool iterate(const Side& side, int iterations, double from_m, double to_m, const RefineOptions& options,
             const PosePrior* prior, Pose* T) {
  bool small = false;
  for (int i = 0; i < iterations; ++i) {
    const double share = iterations > 1 ? std::min(1.0, 1.5 * i / (iterations - 1.0)) : 1.0;
    Normals sum = accumulate(side, *T, from_m * std::pow(to_m / from_m, share), options);
    if (sum.pairs < 12) return false;
    if (prior != nullptr) add_prior(*prior, *T, &sum);
    const Vector6d step = solve(sum);
    *T = moved(*T, step);
    small = step.head<3>().norm() < 2e-4 && step.tail<3>().norm() < 5e-4;
    if (small && share >= 1.0) return true;
  }
  return small;
}

}  // namespace

Fit fit_of(const Target& target, const Cloud& cloud_source, const Pose& T_target_source, double distance_m) {
  const Eigen::Isometry3f T = T_target_source.cast<float>();
  std::size_t near = 0;
  double squared_sum = 0;
  for (const auto& point : cloud_source.points) {
    const Eigen::Vector3f p = T * point;
    const std::int32_t j = target->nearest.nearest(p);
    if (j == NearestGrid::kNone) continue;
    const float squared = (p - target->cloud.points[static_cast<std::size_t>(j)]).squaredNorm();
    if (squared > distance_m * distance_m) continue;
    ++near;
    squared_sum += static_cast<double>(squared);
  }
  if (near == 0) return {};
  return {static_cast<double>(near) / static_cast<double>(cloud_source.size()),
          std::sqrt(squared_sum / static_cast<double>(near))};
}

Alignment refine(const Target& target, const Query& query, const Pose& T_target_source_guess,
                 const RefineOptions& options, const PosePrior* prior) {
  Alignment result;
  Pose T = T_target_source_guess;
  const double middle_m = std::min(options.start_distance_m, 2 * options.end_distance_m);
  iterate({target->coarse, target->nearest_coarse, query.sparse}, options.sparse_iterations,
          options.start_distance_m, middle_m, options, prior, &T);
  iterate({target->coarse, target->nearest_coarse, query.medium}, options.coarse_iterations, middle_m, middle_m,
          options, prior, &T);
  const Side fine{target->cloud, target->nearest, query.medium};
  result.converged =
      iterate(fine, options.fine_iterations, middle_m, options.end_distance_m, options, prior, &T);
  result.T_target_source = normalized(T);

  const Normals sum = accumulate(fine, result.T_target_source, options.end_distance_m, options);
  result.pairs = sum.pairs;
  result.pair_share = query.medium.empty() ? 0.0 : sum.pairs / static_cast<double>(query.medium.size());
  if (sum.pairs >= 12 && sum.weight > 0) {
    result.inlier_rmse_m = std::sqrt(sum.squared / sum.weight);
  }
  result.fitness = fit_of(target, query.cloud, result.T_target_source, options.fit_distance_m).fitness;
  return result;
}

}  // namespace liloc
