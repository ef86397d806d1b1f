#include "common/registration/search/feature_samples.hpp"

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <optional>
#include <random>

namespace liloc {
namespace {

// Two normals; by hand on three scenes of published pairs, where half and twice these find 2 to 4 % fewer.
constexpr float kShortest = 7.0F;       // spacings between the two points, so that noise turns a pose little
constexpr float kLengths = 1.0F;        // spacings by which both distances may differ, and of them ...
constexpr float kLengthsShare = 0.05F;  // ... this share
constexpr float kAngles = 0.2F;  // by which cosines of normals and of the line between the points may differ
constexpr float kNormalsAgree = 0.85F;  // cosine, once posed
constexpr float kLeastTurn = 0.25F;     // squared; normals along the line tell no turn about it
constexpr float kAgrees = 2.5F;         // spacings: so near its partner, a match agrees with a pose
constexpr float kMatchWorth = 4.0F;     // if all matches agree, in fields full of surface
constexpr std::size_t kMatchesAsked = 300, kFirstPoints = 60;  // of each pose, in this order; by hand
constexpr float kPromise = 0.6F;                               // of the floor, after the first points

using Pose3f = Eigen::Isometry3f;

bool sides_agree(const FeatureMatch& a, const FeatureMatch& b, float ratio) {
  const float source = (a.source - b.source).norm(), target = (a.target - b.target).norm();
  return std::min(source, target) > 0.3F && std::min(source, target) >= ratio * std::max(source, target);
}

/// Least-squares rigid transform of three pairs (Umeyama 1991, without scale).
Pose3f from_three(const FeatureMatch& a, const FeatureMatch& b, const FeatureMatch& c) {
  const Eigen::Vector3f source = (a.source + b.source + c.source) / 3,
                        target = (a.target + b.target + c.target) / 3;
  const Eigen::Matrix3f covariance = (a.target - target) * (a.source - source).transpose() +
                                     (b.target - target) * (b.source - source).transpose() +
                                     (c.target - target) * (c.source - source).transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3f> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3f signs(1, 1, (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1.0F : 1.0F);
  Pose3f T = Pose3f::Identity();
  T.linear() = svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
  T.translation() = target - T.linear() * source;
  return T;
}

bool normals_agree(const Pose3f& T, const FeatureMatch& m, float cosine) {
  return (T.linear() * m.source_normal).dot(m.target_normal) > cosine;
}

/// Whether two points with normals lie to each other in the source as they do in the target.
bool alike(const FeatureMatch& a, const FeatureMatch& b, float spacing_m) {
  const Eigen::Vector3f source = b.source - a.source, target = b.target - a.target;
  const float shortest = kShortest * spacing_m;
  if (std::min(source.squaredNorm(), target.squaredNorm()) < shortest * shortest) return false;
  const float of_source = source.norm(), of_target = target.norm();
  if (std::abs(of_source - of_target) > kLengths * spacing_m + kLengthsShare * std::max(of_source, of_target))
    return false;
  const auto differ = [&](float cosine_source, float cosine_target) {
    return std::abs(cosine_source - cosine_target) > kAngles;
  };
  return !differ(a.source_normal.dot(b.source_normal), a.target_normal.dot(b.target_normal)) &&
         !differ(a.source_normal.dot(source) / of_source, a.target_normal.dot(target) / of_target) &&
         !differ(b.source_normal.dot(source) / of_source, b.target_normal.dot(target) / of_target);
}

/// The line between the points onto that of the target, then turned about it as both normals ask.
std::optional<Pose3f> from_two(const FeatureMatch& a, const FeatureMatch& b) {
  const Eigen::Vector3f axis = (b.target - a.target).normalized();
  const Eigen::Matrix3f R_line =
      Eigen::Quaternionf::FromTwoVectors(b.source - a.source, b.target - a.target).toRotationMatrix();
  float cosine = 0, sine = 0;
  for (const FeatureMatch* m : {&a, &b}) {
    const Eigen::Vector3f turned = R_line * m->source_normal;
    cosine += turned.dot(m->target_normal) - turned.dot(axis) * m->target_normal.dot(axis);
    sine += axis.dot(turned.cross(m->target_normal));
  }
  if (cosine * cosine + sine * sine < kLeastTurn) return std::nullopt;
  Pose3f T = Pose3f::Identity();
  T.linear() = Eigen::AngleAxisf(std::atan2(sine, cosine), axis).toRotationMatrix() * R_line;
  T.translation() = (a.target + b.target) / 2 - T.linear() * ((a.source + b.source) / 2);
  if (!normals_agree(T, a, kNormalsAgree) || !normals_agree(T, b, kNormalsAgree)) return std::nullopt;
  return T;
}

/// One run over one set of matches.
class Sampler {
 public:
  Sampler(const ScoreField& field, const std::vector<Eigen::Vector3f>& points,
          const std::vector<FeatureMatch>& matches, const SampleOptions& options)
      : field_(field), points_(points), matches_(matches), options_(options), rng_(options.seed) {
    if (options.sample == Sample::two_normals)
      for (std::size_t i = 0; i < kMatchesAsked; ++i) asked_.push_back(any());
  }

  std::vector<Candidate> run() {
    for (int i = 0; i < options_.iterations; ++i)
      if (const auto T = options_.sample == Sample::two_normals ? two() : three()) offer(*T);
    return std::move(best_);
  }

 private:
  const FeatureMatch& any() { return matches_[rng_() % matches_.size()]; }

  std::optional<Pose3f> two() {
    const FeatureMatch &a = any(), &b = any();
    if (!alike(a, b, static_cast<float>(options_.spacing_m))) return std::nullopt;
    return from_two(a, b);
  }

  std::optional<Pose3f> three() {
    const auto ratio = static_cast<float>(options_.edge_ratio);
    const FeatureMatch &a = any(), &b = any();
    if (!sides_agree(a, b, ratio)) return std::nullopt;
    const FeatureMatch& c = any();
    if (!sides_agree(a, c, ratio) || !sides_agree(b, c, ratio)) return std::nullopt;
    const Pose3f T = from_three(a, b, c);
    for (const FeatureMatch* m : {&a, &b, &c})
      if (!normals_agree(T, *m, 0.7F)) return std::nullopt;
    return T;
  }

  /// What the share of matches that agree with a pose is worth.
  [[nodiscard]] float worth_of_matches(const Pose3f& T) const {
    if (asked_.empty()) return 0;
    const float near_m = kAgrees * static_cast<float>(options_.spacing_m);
    int agree = 0;
    for (const FeatureMatch& m : asked_) agree += (T * m.source - m.target).squaredNorm() < near_m * near_m;
    return kMatchWorth * ScoreField::kSurface * static_cast<float>(agree) / static_cast<float>(asked_.size());
  }

  /// Mean worth of the points on the field and that of the matches, or a low value as soon as the first points
  /// promise less than the worst that is kept.
  [[nodiscard]] float score_of(const Pose3f& T) const {
    const int least = options_.free_space ? -ScoreField::kSurface : 0;
    const float matches = worth_of_matches(T);
    int sum = 0;
    std::size_t seen = 0;
    for (const Eigen::Vector3f& p : points_) {
      sum += std::max(least, field_.at(T * p, ScoreField::kAny));
      if (++seen == kFirstPoints && static_cast<float>(sum) / kFirstPoints + matches < kPromise * floor_)
        return -1e9F;
    }
    return static_cast<float>(sum) / static_cast<float>(std::max<std::size_t>(seen, 1)) + matches;
  }

  void offer(const Pose3f& T) {
    const auto worse = [](const Candidate& a, const Candidate& b) { return a.score > b.score; };
    const float score = score_of(T);
    if (score <= floor_) return;
    best_.push_back({T.cast<double>(), score / ScoreField::kSurface});
    std::push_heap(best_.begin(), best_.end(), worse);
    if (best_.size() <= options_.keep) return;
    std::pop_heap(best_.begin(), best_.end(), worse);
    best_.pop_back();
    floor_ = static_cast<float>(best_.front().score) * ScoreField::kSurface;
  }

  const ScoreField& field_;
  const std::vector<Eigen::Vector3f>& points_;
  const std::vector<FeatureMatch>& matches_;
  const SampleOptions& options_;
  std::mt19937_64 rng_;
  std::vector<FeatureMatch> asked_;
  std::vector<Candidate> best_;
  float floor_ = 0;  ///< the worst score of what is kept, once that is enough
};

}  // namespace

std::vector<Candidate> sample_poses(const ScoreField& field, const std::vector<Eigen::Vector3f>& points,
                                    const std::vector<FeatureMatch>& matches, const SampleOptions& options) {
  if (matches.size() < 3) return {};
  return Sampler(field, points, matches, options).run();
}

}  // namespace liloc
