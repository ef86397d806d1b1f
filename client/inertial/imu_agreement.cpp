#include "client/inertial/imu_agreement.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "client/inertial/seen_and_felt.hpp"

namespace liloc {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Steps that tell something of a gyro turn by more than registration errs by (2 mrad), several times over.
constexpr double kTurningRad = 0.015;
// What registration may err by, and intrinsics that are 10 % off with a mounting that is 10 degrees off.
constexpr double kErrorRad = 0.006, kErrorShare = 0.3;
constexpr StampNs kRecent = from_ms(3000);              // of steps that tell a factor; by hand
constexpr StampNs kOffsetWindow = from_ms(8000);        // of rates that tell an offset: DECISIONS.md
constexpr std::size_t kJudged = 6, kContradicting = 4;  // of the newest steps
constexpr std::size_t kProving = 10, kMostStrays = 1;   // of the newest, to be trusted again; by hand

constexpr std::size_t kFewest = 20;    // steps that tell an offset
constexpr double kFactorSeenS = 1.2;   // that tell a factor
constexpr double kFewestRad_s = 0.08;  // rms of the rate's changes, five times what registration errs by
constexpr double kClear = 0.85, kClearFactor = 0.7;                                      // squared correlation
constexpr StampNs kFarthest = from_ms(3000), kCoarse = from_ms(40), kFine = from_ms(5);  // DECISIONS.md
constexpr StampNs kLeast = from_ms(20);    // less is within what a filter for one clock copes with
constexpr double kAsRight = 0.01;          // of the squared correlation, and ...
constexpr double kCoarselyAsRight = 0.05;  // ... half a coarse step beside the place, at a sway a second

std::optional<Matrix3d> felt_turn(const MotionRecord& record, const SeenStep& step,
                                  const Vector3d& bias_rad_s) {
  const auto pieces = felt_in_pieces(record, step);
  if (pieces.empty()) return std::nullopt;
  const double dt = step.seconds() / static_cast<double>(pieces.size());
  Matrix3d turn = Matrix3d::Identity();
  for (const FeltStep& piece : pieces) turn *= so3_exp(dt * (piece.rate_rad_s - bias_rad_s));
  return turn;
}

/// Of the newest steps with enough rotation, how many were felt as they were seen, and how many not.
std::pair<std::size_t, std::size_t> compared(const MotionRecord& record, const Vector3d& bias_rad_s,
                                             std::size_t most) {
  std::size_t agree = 0, contradict = 0;
  const auto& seen = record.seen();
  if (seen.empty()) return {};
  const StampNs recent = window_ns(record, kRecent);
  for (auto step = seen.rbegin(); step != seen.rend() && agree + contradict < most; ++step) {
    if (!is_recent(record, *step, recent)) break;
    const auto felt = felt_turn(record, *step, bias_rad_s);
    if (!felt) continue;
    const Matrix3d turn = so3_exp(step->seconds() * step->rate_rad_s);
    const double turned = std::max(so3_log(*felt).norm(), so3_log(turn).norm());
    if (turned < kTurningRad) continue;
    const double off = so3_log(turn.transpose() * *felt).norm();
    ++(off > kErrorRad + kErrorShare * turned ? contradict : agree);
  }
  return {agree, contradict};
}

Pairs rates(const MotionRecord& record, StampNs ahead_ns, StampNs last) {
  Pairs rates;
  for (const SeenStep& step : record.seen())
    if (const auto felt = record.felt(step, ahead_ns); felt && is_recent(record, step, last)) {
      rates.seen.push_back(step.rate_rad_s);
      rates.felt.push_back(felt->rate_rad_s);
      rates.seconds += step.seconds();
    }
  return rates;
}

Fit fit_at(const MotionRecord& record, StampNs ahead_ns) {
  const Pairs r = rates(record, ahead_ns, kOffsetWindow);
  return r.seen.size() < kFewest ? Fit{} : fit(r, mean(r.seen), mean(r.felt), kFewestRad_s);
}

}  // namespace

Agreement gyro_agreement(const MotionRecord& record, const Vector3d& bias_rad_s) {
  if (compared(record, bias_rad_s, kJudged).second >= kContradicting) return Agreement::contradicts;
  const auto [agree, contradict] = compared(record, bias_rad_s, kProving);
  return agree + contradict >= kProving && contradict <= kMostStrays ? Agreement::agrees : Agreement::unknown;
}

std::optional<double> gyro_factor(const MotionRecord& record) {
  if (record.seen().empty()) return std::nullopt;
  const Pairs felt = rates(record, 0, window_ns(record, kRecent));
  if (felt.seconds < kFactorSeenS) return std::nullopt;
  const Fit found = fit(felt, Vector3d::Zero(), Vector3d::Zero(), kFewestRad_s);
  if (found.squared < kClearFactor) return std::nullopt;
  return found.factor;
}

std::optional<StampNs> stamps_ahead_ns(const MotionRecord& record) {
  Fit best;
  StampNs best_ns = 0;
  std::vector<double> places;  // squared correlations from the farthest behind to the farthest ahead
  const auto search = [&](StampNs from_ns, StampNs to_ns, StampNs step_ns) {
    for (StampNs ahead_ns = from_ns; ahead_ns <= to_ns; ahead_ns += step_ns) {
      const Fit here = fit_at(record, ahead_ns);
      if (step_ns == kCoarse) places.push_back(here.squared);
      if (here.squared <= best.squared) continue;
      best = here;
      best_ns = ahead_ns;
    }
  };
  search(-kFarthest, kFarthest, kCoarse);
  search(best_ns - kCoarse, best_ns + kCoarse, kFine);
  if (best.squared < kClear || best.factor < 0.8 || best.factor > 1.25 || std::abs(best_ns) < kLeast ||
      std::abs(best_ns) > kFarthest - kCoarse)
    return std::nullopt;
  const auto as_right = [&](double squared, double slack) {
    return 1 - squared < 2 * (1 - best.squared) + slack;
  };
  if (as_right(fit_at(record, 0).squared, kAsRight)) return std::nullopt;
  int right_places = 0;
  bool right_before = false;
  for (const double squared : places) {
    const bool right = as_right(squared, kCoarselyAsRight);
    right_places += right && !right_before;
    right_before = right;
  }
  if (right_places > 1) return std::nullopt;  // the motion repeats itself
  return best_ns;
}

}  // namespace liloc
