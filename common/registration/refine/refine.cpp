#include "common/registration/refine/refine.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "common/registration/refine/plane_pairs.hpp"

namespace liloc {
namespace {

/// The pairs of a side at each pose that is tried.
class Pairs {
 public:
  Pairs(const Side& side, const RefineOptions& options) : side_(side), options_(options) {
    if (!options.point_to_point && side.source.has_normals() && side.target.has_normals())
      to_plane_.emplace(side);
  }

  [[nodiscard]] double hold() const { return options_.hold; }
  [[nodiscard]] NormalEquations at(const Pose& T, double distance_m) {
    return to_plane_ ? to_plane_->at(T, distance_m, options_.min_normal_agreement)
                     : point_to_point(T, distance_m);
  }

 private:
  [[nodiscard]] NormalEquations point_to_point(const Pose& T, double distance_m) const {
    NormalEquations sum;
    for_each_pair(side_, T, distance_m, options_.min_normal_agreement,
                  [&](std::size_t, const Eigen::Vector3f& arm, const Eigen::Vector3f&,
                      const Eigen::Vector3f& offset, double weight) {
                    for (int axis = 0; axis < 3; ++axis) {
                      const Vector6d jacobian = jacobian_of(arm, Eigen::Vector3f::Unit(axis));
                      const auto residual = static_cast<double>(offset[axis]);
                      sum.H.noalias() += weight * jacobian * jacobian.transpose();
                      sum.g.noalias() += weight * residual * jacobian;
                      sum.squared += weight * residual * residual;
                      sum.weight += weight;
                      ++sum.pairs;
                    }
                  });
    return sum;
  }

  const Side side_;
  const RefineOptions& options_;
  std::optional<PlanePairs> to_plane_;
};

/// Solves for the step, holding back directions that the pairs hardly observe.
Vector6d solve(const NormalEquations& sum) {
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

/// Pulls towards a pose, in the same axes as the pairs: about the source's origin.
void add_pull(const Pose& T_wanted, double w_rotation, double w_shift, const Pose& T, NormalEquations* sum) {
  const Eigen::Vector3d turn = so3_log(T.linear() * T_wanted.linear().transpose());
  sum->H.topLeftCorner<3, 3>().diagonal().array() += w_rotation;
  sum->H.bottomRightCorner<3, 3>().diagonal().array() += w_shift;
  sum->g.head<3>() += w_rotation * turn;
  sum->g.tail<3>() += w_shift * (T.translation() - T_wanted.translation());
}

void add_prior(const PosePrior& prior, const Pose& T, NormalEquations* sum) {
  const double variance = prior.residual_sd_m * prior.residual_sd_m;
  add_pull(prior.T_target_source, variance / (prior.sd_rad * prior.sd_rad),
           variance / (prior.sd_m * prior.sd_m), T, sum);
}

/// As if a share of the pairs held every direction; one pair in two tells of a turn about an axis.
void add_hold(double share, const Pose& T_start, const Pose& T, NormalEquations* sum) {
  const double turning = sum->H.topLeftCorner<3, 3>().trace() / 2;
  add_pull(T_start, share * turning, share * sum->weight, T, sum);
}

/// The distance of pairs between far and near.
double middle_of(const RefineOptions& options) {
  return std::min(options.start_distance_m, 2 * options.end_distance_m);
}

/// Iterates with a distance that shrinks geometrically; true when the last step was small.
bool iterate(Pairs& pairs, int iterations, double from_m, double to_m, const PosePrior* prior, Pose* T) {
  bool small = false;
  const Pose T_start = *T;
  for (int i = 0; i < iterations; ++i) {
    const double share = iterations > 1 ? std::min(1.0, 1.5 * i / (iterations - 1.0)) : 1.0;
    NormalEquations sum = pairs.at(*T, from_m * std::pow(to_m / from_m, share));
    if (sum.pairs < 12) return false;
    if (prior != nullptr) add_prior(*prior, *T, &sum);
    if (pairs.hold() > 0) add_hold(pairs.hold(), T_start, *T, &sum);
    const Vector6d step = solve(sum);
    *T = moved(*T, step);
    small = step.head<3>().norm() < 2e-4 && step.tail<3>().norm() < 5e-4;
    if (small && share >= 1.0) return true;
  }
  return small;
}

/// How many points of the source may pair: those that are not beside somebody.
std::size_t unhindered(const Side& side, const Pose& T) {
  if (side.dynamic_mask == nullptr) return side.source.size();
  const Eigen::Isometry3f Tf = T.cast<float>();
  return static_cast<std::size_t>(std::ranges::count_if(
      side.source.points, [&](const Eigen::Vector3f& p) { return !side.dynamic_mask->at(Tf * p); }));
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

Pose approach(const Target& target, const Query& query, const Pose& T_target_source_guess, int iterations,
              const RefineOptions& options) {
  Pose T = T_target_source_guess;
  Pairs far(coarse_side(target, query.sparse), options);
  iterate(far, iterations, options.start_distance_m, middle_of(options), nullptr, &T);
  return normalized(T);
}

Alignment refine(const Target& target, const Query& query, const Pose& T_target_source_guess,
                 const RefineOptions& options, const PosePrior* prior) {
  Alignment result;
  Pose T = T_target_source_guess;
  const double middle_m = middle_of(options);
  Pairs far(coarse_side(target, query.sparse), options);
  iterate(far, options.sparse_iterations, options.start_distance_m, middle_m, prior, &T);
  Pairs near(coarse_side(target, query.medium), options);
  iterate(near, options.coarse_iterations, middle_m, middle_m, prior, &T);
  Pairs fine(fine_side(target, query.medium), options);
  result.converged = iterate(fine, options.fine_iterations, middle_m, options.end_distance_m, prior, &T);
  result.T_target_source = normalized(T);

  const NormalEquations sum = fine.at(result.T_target_source, options.end_distance_m);
  result.pairs = sum.pairs;
  const std::size_t free = unhindered(fine_side(target, query.medium), result.T_target_source);
  result.pair_share = free == 0 ? 0.0 : sum.pairs / static_cast<double>(free);
  if (sum.pairs >= 12 && sum.weight > 0) {
    result.inlier_rmse_m = std::sqrt(sum.squared / sum.weight);
  }
  result.fitness = fit_of(target, query.cloud, result.T_target_source, options.fit_distance_m).fitness;
  return result;
}

}  // namespace liloc
