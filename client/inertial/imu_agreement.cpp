#include "client/inertial/imu_agreement.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace liloc {
namespace {

using Eigen::Vector3d;

// Steps that tell something of a gyro turn by more than registration errs by (2 mrad), several times over.
constexpr double kTurningRad = 0.015;
// What registration may err by, and intrinsics that are 10 % off with a mounting that is 10 degrees off.
constexpr double kErrorRad = 0.006, kErrorShare = 0.3;
constexpr StampNs kRecent = from_ms(3000), kAll = std::numeric_limits<StampNs>::max();
constexpr std::size_t kJudged = 6, kContradicting = 4;  // of the newest steps
constexpr std::size_t kProving = 10, kMostStrays = 1;

constexpr StampNs kForceWindow = from_ms(2000);
constexpr std::size_t kForceSteps = 15;
constexpr double kGravity = 9.81;
constexpr double kForceOff = 2.5;    // m/s^2: over two seconds nobody gains 5 m/s
constexpr double kForceMoved = 3.5;  // and over twice that nobody both gains and loses as much

constexpr std::size_t kFewest = 20;    // steps that tell an offset or a factor
constexpr double kFewestRad_s = 0.08;  // rms of the rate's changes, five times what registration errs by
constexpr double kClear = 0.85, kClearFactor = 0.7;  // squared correlation
constexpr StampNs kFarthest = from_ms(3000), kCoarse = from_ms(40), kFine = from_ms(5);
constexpr StampNs kLeast = from_ms(20);  // less is within what a filter for one clock copes with

/// Of the newest steps with enough rotation, how many were felt as they were seen, and how many not.
std::pair<std::size_t, std::size_t> compared(const MotionRecord& record, const Vector3d& bias_rad_s,
                                             std::size_t most) {
  std::size_t agree = 0, contradict = 0;
  const auto& seen = record.seen();
  for (auto step = seen.rbegin(); step != seen.rend() && agree + contradict < most; ++step) {
    if (seen.back().to_ns - step->to_ns > kRecent) break;
    const auto felt = record.felt(*step);
    if (!felt) continue;
    const Vector3d rate = felt->rate_rad_s - bias_rad_s;
    const double turned = step->seconds() * std::max(rate.norm(), step->rate_rad_s.norm());
    if (turned < kTurningRad) continue;
    const double off = step->seconds() * (rate - step->rate_rad_s).norm();
    ++(off > kErrorRad + kErrorShare * turned ? contradict : agree);
  }
  return {agree, contradict};
}

/// Rates seen and felt.
struct Rates {
  std::vector<Vector3d> seen, felt;
};

Rates rates(const MotionRecord& record, StampNs ahead_ns, StampNs last = kAll) {
  Rates rates;
  for (const SeenStep& step : record.seen())
    if (const auto felt = record.felt(step, ahead_ns); felt && record.seen().back().to_ns - step.to_ns < last) {
      rates.seen.push_back(step.rate_rad_s);
      rates.felt.push_back(felt->rate_rad_s);
    }
  return rates;
}

Vector3d mean(const std::vector<Vector3d>& values) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& v : values) sum += v;
  return sum / static_cast<double>(std::max<std::size_t>(values.size(), 1));
}

struct Fit {
  double factor = 0, squared = 0;  ///< felt over seen, and squared correlation
};

/// About the values' means, or about the given ones.
Fit fit(const Rates& rates, const Vector3d& seen_0, const Vector3d& felt_0) {
  double ss = 0, sf = 0, ff = 0;
  for (std::size_t i = 0; i < rates.seen.size(); ++i) {
    const Vector3d s = rates.seen[i] - seen_0, f = rates.felt[i] - felt_0;
    ss += s.squaredNorm();
    sf += s.dot(f);
    ff += f.squaredNorm();
  }
  const auto n = static_cast<double>(rates.seen.size());
  if (rates.seen.size() < kFewest || ss < n * kFewestRad_s * kFewestRad_s || ff <= 0 || sf <= 0) return {};
  return {ff / sf, sf * sf / (ss * ff)};
}

Fit fit_at(const MotionRecord& record, StampNs ahead_ns) {
  const Rates r = rates(record, ahead_ns);
  return fit(r, mean(r.seen), mean(r.felt));
}

std::optional<Vector3d> mean_force_between(const MotionRecord& record, StampNs from_ns, StampNs to_ns) {
  std::vector<Vector3d> forces;
  for (const SeenStep& step : record.seen()) {
    if (step.to_ns <= from_ns || step.to_ns > to_ns) continue;
    if (const auto felt = record.felt(step))
      forces.emplace_back(step.R_odom_imu * so3_exp(-0.5 * step.seconds() * step.rate_rad_s) *
                          felt->force_m_s2);
  }
  if (forces.size() < kForceSteps) return std::nullopt;
  return mean(forces);
}

}  // namespace

Agreement gyro_agreement(const MotionRecord& record, const Vector3d& bias_rad_s) {
  if (compared(record, bias_rad_s, kJudged).second >= kContradicting) return Agreement::contradicts;
  const auto [agree, contradict] = compared(record, bias_rad_s, kProving);
  return agree + contradict >= kProving && contradict <= kMostStrays ? Agreement::agrees : Agreement::unknown;
}

std::optional<Vector3d> mean_force_m_s2(const MotionRecord& record) {
  if (record.seen().empty()) return std::nullopt;
  const StampNs now = record.seen().back().to_ns;
  return mean_force_between(record, now - kForceWindow, now);
}

Agreement force_agreement(const MotionRecord& record) {
  const auto newest = mean_force_m_s2(record);
  if (!newest) return Agreement::unknown;
  if (std::abs(newest->norm() - kGravity) > kForceOff) return Agreement::contradicts;
  const StampNs now = record.seen().back().to_ns;
  const auto before = mean_force_between(record, now - 2 * kForceWindow, now - kForceWindow);
  return before && (*before - *newest).norm() > kForceMoved ? Agreement::contradicts : Agreement::agrees;
}

std::optional<double> gyro_factor(const MotionRecord& record) {
  const Fit found = fit(rates(record, 0, kRecent), Vector3d::Zero(), Vector3d::Zero());
  if (found.squared < kClearFactor) return std::nullopt;
  return found.factor;
}

std::optional<StampNs> stamps_ahead_ns(const MotionRecord& record) {
  Fit best;
  StampNs best_ns = 0;
  const auto search = [&](StampNs from_ns, StampNs to_ns, StampNs step_ns) {
    for (StampNs ahead_ns = from_ns; ahead_ns <= to_ns; ahead_ns += step_ns)
      if (const Fit here = fit_at(record, ahead_ns); here.squared > best.squared) {
        best = here;
        best_ns = ahead_ns;
      }
  };
  search(-kFarthest, kFarthest, kCoarse);
  search(best_ns - kCoarse, best_ns + kCoarse, kFine);
  if (best.squared < kClear || best.factor < 0.8 || best.factor > 1.25 || std::abs(best_ns) < kLeast)
    return std::nullopt;
  if (1 - fit_at(record, 0).squared < 2 * (1 - best.squared) + 0.01) return std::nullopt;
  return best_ns;
}

}  // namespace liloc
