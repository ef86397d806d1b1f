#include "common/registration/scan/scan_match.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "common/geometry/pose_estimate.hpp"

namespace liloc {
namespace {

constexpr std::size_t kFewestPairs = 6;  // as many as unknowns
constexpr double kUsualRangeM = 2.0;     // at which a turn shows as a shift; by hand
using Matrix6f = PatchWeights::Matrix6f;
using Vector6f = PatchWeights::Vector6f;

// Weighs radians against metres when directions are compared; by hand.
constexpr double kCharacteristicLengthM = 2.0;

struct Source {
  Eigen::Vector3f mean, normal;
  float weight;
  float sd;
  std::uint32_t patch;
};

struct Sources {
  std::vector<Source> surfels;
  std::size_t patches = 0;
};

/// A source surfel and its plane, for one iteration.
struct Pair {
  Eigen::Vector3f lever;  ///< of the transformed point about the sensor, map axes
  Eigen::Vector3f normal;
  float residual;
  float weight;
  float sd;
  float normal_variance;  ///< rad^2, of the plane's normal
  std::uint32_t patch;

  /// Of the residual, by a turn about the sensor and a shift.
  [[nodiscard]] Vector6f jacobian() const {
    Vector6f J;
    J.head<3>() = lever.cross(normal);
    J.tail<3>() = normal;
    return J;
  }
};

/// Flat surfels, at most so many, evenly.
Sources choose_sources(const std::vector<Surfel>& frame, const ScanMatchOptions& options) {
  std::vector<const Surfel*> flat;
  flat.reserve(frame.size());
  for (const Surfel& s : frame)
    if (s.flatness >= static_cast<float>(options.min_flatness)) flat.push_back(&s);
  const std::size_t count = std::min(flat.size(), options.max_surfels);
  const double step = static_cast<double>(flat.size()) / static_cast<double>(std::max<std::size_t>(count, 1));
  PatchNumbers numbers(options.patch.size_m);
  Sources sources;
  sources.surfels.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Surfel& s = *flat[static_cast<std::size_t>(static_cast<double>(i) * step)];
    const float range = s.mean.norm();
    const float sd = static_cast<float>(options.sensor_sd_m + options.noise_per_m2 * range * range);
    sources.surfels.push_back({s.mean, s.normal, s.flatness, sd, numbers.of(s.mean, s.normal)});
  }
  sources.patches = numbers.count();
  return sources;
}

void find_pairs(const LocalMap& map, const std::vector<Source>& sources, const Pose& T, StampNs now_ns,
                int reach, std::vector<Pair>& pairs) {
  pairs.clear();
  const Eigen::Isometry3f Tf = T.cast<float>();
  for (const Source& s : sources) {
    const Eigen::Vector3f lever = Tf.linear() * s.mean, p = lever + Tf.translation();
    const LocalMap::Cell* cell = map.find(p, Tf.linear() * s.normal, reach);
    if (cell == nullptr) continue;
    const float trust = map.trust(*cell, now_ns) * std::max(0.1F, cell->surfel.flatness);
    const Surfel& plane = cell->surfel;
    const float thinness = 1 - plane.flatness;
    pairs.push_back({lever, plane.normal, plane.normal.dot(p - plane.mean), s.weight * trust, s.sd,
                     thinness * thinness / plane.count, s.patch});
  }
}

struct Normal {
  Matrix6d H = Matrix6d::Zero();
  Vector6d b = Vector6d::Zero();
  double noise = 0;  ///< information along a direction that no plane faces, from errors of the normals alone
};

/// Half-width of the kernel, squared: what noise and a guess of covariance `doubt` let the residual be. Of a
/// wall that is little, along a direction that is in doubt it is much; a person who walked off is outside of
/// both.
float kernel_squared(const Pair& p, const Matrix6f& doubt, const Vector6f& J, bool wide_prior,
                     const ScanMatchOptions& options) {
  const auto low = static_cast<float>(options.kernel_min_m);
  const auto high = static_cast<float>(wide_prior ? options.kernel_wide_m : options.kernel_max_m);
  const auto deviations = static_cast<float>(options.kernel_deviations);
  const float expected = p.sd * p.sd + J.dot(doubt * J);
  return std::clamp(deviations * deviations * expected, low * low, high * high);
}

Normal accumulate(const std::vector<Pair>& pairs, std::size_t patches, const Matrix6d& doubt, bool wide_prior,
                  const ScanMatchOptions& options) {
  Normal n;
  const Matrix6f doubtf = doubt.cast<float>();
  PatchWeights sums(patches);
  for (const Pair& p : pairs) sums.add(p.patch, p.weight, p.residual, p.sd * p.sd, p.jacobian());
  const std::vector<float> patch_weights = sums.weights(doubtf, options.patch);
  for (const Pair& p : pairs) {
    const Vector6f J = p.jacobian();
    const float scaled = p.residual * p.residual / kernel_squared(p, doubtf, J, wide_prior, options);
    const float robust = patch_weights[p.patch] / ((1 + scaled) * (1 + scaled));
    const double weight = static_cast<double>(p.weight) * robust / (static_cast<double>(p.sd) * p.sd);
    n.noise += weight * static_cast<double>(p.normal_variance);
    const Vector6d Jd = J.cast<double>();
    n.H.selfadjointView<Eigen::Lower>().rankUpdate(Jd, weight);
    n.b -= Jd * (weight * static_cast<double>(p.residual));
  }
  n.H = n.H.selfadjointView<Eigen::Lower>();
  return n;
}

/// Leaves the directions that the scene does not observe to the guess: what noisy normals feign there is taken
/// out.
void drop_unobserved(Normal& n, const ScanMatchOptions& options, ScanMatch& match) {
  Vector6d unit = Vector6d::Ones();
  unit.head<3>() /= kCharacteristicLengthM;
  const Matrix6d scaled = unit.asDiagonal() * n.H * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> solver(scaled);
  const double least = std::max(options.observed_share * scaled.trace(), options.observed_noise * n.noise);
  Matrix6d keep = Matrix6d::Zero();
  match.unobserved = 0;
  for (int i = 0; i < 6; ++i) {
    if (solver.eigenvalues()[i] < least) {
      ++match.unobserved;
      continue;
    }
    const Vector6d v = solver.eigenvectors().col(i);
    keep += v * v.transpose();
  }
  match.observed = keep;
  if (match.unobserved == 0) return;
  const Matrix6d project = unit.cwiseInverse().asDiagonal() * keep * unit.asDiagonal();
  n.H = project * n.H * project.transpose();
  n.b = project * n.b;
}

/// Adds the guess as a measurement of the pose.
void add_prior(Normal& n, const MotionGuess& guess, const Matrix6d& certainty, const Pose& T) {
  Vector6d back;
  back.head<3>() = so3_log(guess.T_map_sensor.linear() * T.linear().transpose());
  back.tail<3>() = guess.T_map_sensor.translation() - T.translation();
  n.H += certainty;
  n.b += certainty * back;
}

/// Turns about the sensor, so that rotation and translation stay decoupled far from the map's origin.
void apply(Pose& T, const Vector6d& step) {
  T.linear() = so3_exp(step.head<3>()) * T.linear();
  T.translation() += step.tail<3>();
}

void grade(ScanMatch& match, const std::vector<Pair>& pairs, std::size_t sources) {
  double sum = 0, inside = 0;
  for (const Pair& p : pairs) {
    if (std::abs(p.residual) > 3 * p.sd) continue;
    sum += static_cast<double>(p.residual) * p.residual;
    inside += 1;
  }
  const auto all = static_cast<double>(std::max<std::size_t>(sources, 1));
  match.overlap = inside / all;
  match.paired = static_cast<double>(pairs.size()) / all;
  match.rmse_m = inside > 0 ? std::sqrt(sum / inside) : 0;
}

}  // namespace

MotionGuess::MotionGuess(const Pose& T, double sd_rad, double sd_m) : T_map_sensor(T) {
  covariance.diagonal().head<3>().setConstant(sd_rad * sd_rad);
  covariance.diagonal().tail<3>().setConstant(sd_m * sd_m);
}

double MotionGuess::sd_rad() const {
  return std::sqrt(covariance.diagonal().head<3>().maxCoeff());
}

double MotionGuess::sd_m() const {
  return std::sqrt(covariance.diagonal().tail<3>().maxCoeff());
}

double MotionGuess::squared_mahalanobis(const Pose& T_map_sensor_other) const {
  Vector6d off;
  off.head<3>() = so3_log(T_map_sensor_other.linear() * T_map_sensor.linear().transpose());
  off.tail<3>() = T_map_sensor_other.translation() - T_map_sensor.translation();
  return liloc::squared_mahalanobis(off, covariance);
}

Result<ScanMatch> match_scan(const LocalMap& map, const std::vector<Surfel>& frame, const MotionGuess& guess,
                             StampNs now_ns, const ScanMatchOptions& options) {
  if (map.size() == 0) return fail("scan match: the local map is empty; insert a first frame");
  const Sources sources = choose_sources(frame, options);
  if (sources.surfels.empty())
    return fail("scan match: none of {} surfels is flat enough for a normal", frame.size());
  ScanMatch match;
  match.T_map_sensor = options.start.value_or(guess.T_map_sensor);
  const Matrix6d certainty = guess.covariance.inverse();
  match.information = certainty;
  std::vector<Pair> pairs;
  pairs.reserve(sources.surfels.size());
  double share = 1;
  for (match.iterations = 0; match.iterations < options.max_iterations && !match.converged();
       ++match.iterations) {
    const MotionGuess doubt(match.T_map_sensor, share * guess.covariance);
    const bool wide_prior = doubt.sd_m() + kUsualRangeM * doubt.sd_rad() > options.wide_prior_m;
    // What the guess may still be off shrinks with each step; while that is much, planes are looked for farther
    // away.
    share *= wide_prior ? 0.5 : 0.25;
    find_pairs(map, sources.surfels, match.T_map_sensor, now_ns, wide_prior ? 2 : 1, pairs);
    if (pairs.size() < kFewestPairs) {
      match.stop = ScanStop::too_few_pairs;
      break;
    }
    Normal n = accumulate(pairs, sources.patches, doubt.covariance, wide_prior, options);
    drop_unobserved(n, options, match);
    add_prior(n, guess, certainty, match.T_map_sensor);
    match.information = n.H;
    const Vector6d step = n.H.ldlt().solve(n.b);
    apply(match.T_map_sensor, step);
    if (step.head<3>().norm() < options.stop_rad && step.tail<3>().norm() < options.stop_m)
      match.stop = ScanStop::converged;
  }
  grade(match, pairs, sources.surfels.size());
  match.T_map_sensor = normalized(match.T_map_sensor);
  return match;
}

}  // namespace liloc
