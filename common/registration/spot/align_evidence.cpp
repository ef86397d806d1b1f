#include "common/registration/spot/align_evidence.hpp"

#include <algorithm>
#include <cmath>

namespace liloc {
namespace {

constexpr std::size_t kEvery = 3;  // of the target's points, for sketches; by hand
// In pairs; both from 1 to 4 rank alike (spot/DECISIONS.md).
constexpr double kConflictPairs = 4, kMatchPairs = 2;
// By hand.
constexpr double kMostConflict = 0.25;  // of points in known directions; right poses not yet refined have less
// In voxels: how far a refined pose may put points before a surface; one that is not refined; features apart.
// By hand.
constexpr double kTolerance = 3, kTolerancePosed = 5, kToleranceSampled = 9, kMatched = 4;
// Of sketches, and the least cosine between normals; by hand.
constexpr float kPairs_voxels = 3.0F, kFacing = 0.5F;

// Fitted by proto-tests/bench/fit_align.py to poses of 557 pairs of three scenes at a voxel of 0.05 m. Log odds
// of a pose are the sum of these times `align_regressors`; that the first of all is right is the logistic of
// ...
constexpr AlignRegressors kWeights{-19.906, -1.708, 3.123};
constexpr double kOffset = 0.451, kSlope = 0.969;  // ... this line over its log odds, times its share

void add(const Panorama& seen, const std::vector<Eigen::Vector3f>& points, const Pose& T, double tolerance_m,
         double each, Panorama::Count* sum) {
  if (!seen.seen_from_origin()) return;
  const Panorama::Count count = seen.count(points, T, tolerance_m);
  sum->conflict += static_cast<int>(std::lround(each * count.conflict));
  sum->agree += static_cast<int>(std::lround(each * count.agree));
  sum->known += static_cast<int>(std::lround(each * count.known));
}

/// Of some source points, those with a target point so near that faces the same way.
template <class Each>
void for_each_facing(const Cloud& source, const NearestGrid& nearest, const Cloud& target,
                     const Pose& T_target_source, float distance_m, const Each& each) {
  const Eigen::Isometry3f T = T_target_source.cast<float>();
  for (std::size_t i = 0; i < source.size(); ++i) {
    const Eigen::Vector3f p = T * source.points[i];
    const std::int32_t j = nearest.nearest(p);
    if (j == NearestGrid::kNone) continue;
    const auto at = static_cast<std::size_t>(j);
    if ((p - target.points[at]).squaredNorm() > distance_m * distance_m) continue;
    const float cosine = (T.linear() * source.normals[i]).dot(target.normals[at]);
    if (cosine > kFacing) each(target.normals[at], cosine);
  }
}

}  // namespace

AlignRegressors align_regressors(const AlignEvidence& e) {
  return {1.0, std::log((e.conflict + 3.0) / (e.agree + 10.0)), std::log(e.matched + 3.0)};
}

double log_odds_of(const AlignEvidence& evidence) {
  const AlignRegressors x = align_regressors(evidence);
  double sum = 0;
  for (std::size_t i = 0; i < x.size(); ++i) sum += kWeights[i] * x[i];
  return sum;
}

double confidence_of(const std::vector<double>& log_odds) {
  double rivals = 0;
  for (const double other : log_odds) rivals += std::exp(other - log_odds.front());
  return 1.0 / (rivals * (1.0 + std::exp(-kOffset - kSlope * log_odds.front())));
}

AlignWitness::AlignWitness(const SpotProblem& problem, const std::vector<FeatureMatch>& matches,
                           double voxel_size_m)
    : problem_(problem),
      matches_(matches),
      voxel_m_(voxel_size_m),
      source_(problem.query.cloud.points),
      target_(problem.target->cloud.points) {
  for (std::size_t i = 0; i < problem.target->coarse.size(); i += kEvery)
    few_of_target_.push_back(problem.target->coarse.points[i]);
}

AlignEvidence AlignWitness::of(const Alignment& alignment) const {
  const Pose& T = alignment.T_target_source;
  const Query& query = problem_.query;
  const Surfaces& target = *problem_.target.surfaces;
  AlignEvidence e;
  e.pairs = alignment.pairs;
  const Fit fit = fit_of(problem_.target, query.cloud, T, 1.5 * voxel_m_);
  e.fitness = fit.fitness;
  e.rmse_m = fit.inlier_rmse_m;
  e.matched = matched(T);
  Panorama::Count space;
  add(target_, query.medium.points, T, kTolerance * voxel_m_, 1, &space);
  add(source_, target.coarse.points, T.inverse(), kTolerance * voxel_m_, 1, &space);
  e.conflict = space.conflict;
  e.agree = space.agree;
  return e;
}

double AlignWitness::sketch_score(const Pose& T_target_source) const {
  const Query& query = problem_.query;
  int pairs = 0;
  for_each_facing(query.sparse, problem_.target->nearest_coarse, problem_.target->coarse, T_target_source,
                  kPairs_voxels * static_cast<float>(voxel_m_),
                  [&](const Eigen::Vector3f&, float) { ++pairs; });
  const double each = static_cast<double>(query.medium.size()) / static_cast<double>(query.sparse.size());
  const Panorama::Count space = few_in_space(T_target_source, kTolerancePosed * voxel_m_);
  return each * pairs - kConflictPairs * space.conflict + kMatchPairs * matched(T_target_source);
}

bool AlignWitness::possible(const Pose& T_target_source) const {
  const Panorama::Count space = few_in_space(T_target_source, kToleranceSampled * voxel_m_);
  return space.conflict <= kMostConflict * space.known;
}

Panorama::Count AlignWitness::few_in_space(const Pose& T_target_source, double tolerance_m) const {
  const Query& query = problem_.query;
  Panorama::Count space;
  add(target_, query.sparse.points, T_target_source, tolerance_m,
      static_cast<double>(query.medium.size()) / static_cast<double>(query.sparse.size()), &space);
  add(source_, few_of_target_, T_target_source.inverse(), tolerance_m, kEvery, &space);
  return space;
}

int AlignWitness::matched(const Pose& T_target_source) const {
  const Eigen::Isometry3f T = T_target_source.cast<float>();
  const auto near_m = static_cast<float>(kMatched * voxel_m_);
  return static_cast<int>(std::ranges::count_if(matches_, [&](const FeatureMatch& m) {
    return (T * m.source - m.target).squaredNorm() < near_m * near_m;
  }));
}

}  // namespace liloc
