#include "client/inertial/imu_agreement.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace liloc {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Steps that tell something of a gyro turn by more than registration errs by (2 mrad), several times over.
constexpr double kTurningRad = 0.015;
// What registration may err by, and intrinsics that are 10 % off with a mounting that is 10 degrees off.
constexpr double kErrorRad = 0.006, kErrorShare = 0.3;
constexpr StampNs kRecent = from_ms(3000);
constexpr StampNs kOffsetWindow = from_ms(8000), kSignWindow = from_ms(8000);
constexpr double kRareSteps = 12;                       // are looked at where frames are rare
constexpr std::size_t kJudged = 6, kContradicting = 4;  // of the newest steps
constexpr std::size_t kProving = 10, kMostStrays = 1;
constexpr double kPieceS = 0.1;  // over which a device turns evenly

constexpr StampNs kForceWindow = from_ms(2000);
constexpr double kForceSeenS = 1;  // of it
constexpr double kGravity = 9.81;
constexpr double kForceOff = 2.5;    // m/s^2: over two seconds nobody gains 5 m/s
constexpr double kForceMoved = 3.5;  // and over twice that nobody both gains and loses as much

constexpr std::size_t kFewest = 20;    // steps that tell an offset
constexpr double kFactorSeenS = 1.2;   // that tell a factor
constexpr double kFewestRad_s = 0.08;  // rms of the rate's changes, five times what registration errs by
constexpr double kClear = 0.85, kClearFactor = 0.7;  // squared correlation
constexpr StampNs kFarthest = from_ms(3000), kCoarse = from_ms(40), kFine = from_ms(5);
constexpr StampNs kLeast = from_ms(20);  // less is within what a filter for one clock copes with
constexpr double kAsRight = 0.01;        // of the squared correlation, and ...
constexpr double kCoarselyAsRight = 0.05;  // ... half a coarse step beside the place, at a sway a second

constexpr double kSideS = 0.5;  // accelerations are means over as much on either side
constexpr std::size_t kFewestPushes = 5;
constexpr double kPushesSeenS = 2;     // from the first of them to the last
constexpr double kFewestM_s2 = 0.05;   // rms of their changes: registration that errs by 2 mm makes it 0.02
constexpr double kClearSign = 0.5;     // squared correlation
constexpr double kMostFactor = 2;      // either way: what is right, or inverted, is as large as what was seen

/// That long, or longer where frames are rare. Something was seen.
StampNs window_ns(const MotionRecord& record, StampNs at_least) {
  return std::max(at_least, from_seconds(kRareSteps * record.seen().back().seconds()));
}

/// What was felt over a step, however long, in pieces.
std::vector<FeltStep> felt_in_pieces(const MotionRecord& record, const SeenStep& step) {
  const int pieces = static_cast<int>(std::ceil(step.seconds() / kPieceS));
  std::vector<FeltStep> all;
  for (int i = 0; i < pieces; ++i) {
    const auto at = [&](int piece) { return step.from_ns + (step.to_ns - step.from_ns) * piece / pieces; };
    const auto felt = record.felt({at(i), at(i + 1)});
    if (!felt) return {};
    all.push_back(*felt);
  }
  return all;
}

std::optional<Matrix3d> felt_turn(const MotionRecord& record, const SeenStep& step, const Vector3d& bias_rad_s) {
  const auto pieces = felt_in_pieces(record, step);
  if (pieces.empty()) return std::nullopt;
  const double dt = step.seconds() / static_cast<double>(pieces.size());
  Matrix3d turn = Matrix3d::Identity();
  for (const FeltStep& piece : pieces) turn *= so3_exp(dt * (piece.rate_rad_s - bias_rad_s));
  return turn;
}

/// Mean specific force over a step, turned as registration saw it, odometry axes.
std::optional<Vector3d> felt_force(const MotionRecord& record, const SeenStep& step) {
  const auto pieces = felt_in_pieces(record, step);
  if (pieces.empty()) return std::nullopt;
  const auto n = static_cast<double>(pieces.size());
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    const double left_s = step.seconds() * (1 - (static_cast<double>(i) + 0.5) / n);
    sum += step.R_odom_imu * so3_exp(-left_s * step.rate_rad_s) * pieces[i].force_m_s2;
  }
  return sum / n;
}

/// Of the newest steps with enough rotation, how many were felt as they were seen, and how many not.
std::pair<std::size_t, std::size_t> compared(const MotionRecord& record, const Vector3d& bias_rad_s,
                                             std::size_t most) {
  std::size_t agree = 0, contradict = 0;
  const auto& seen = record.seen();
  if (seen.empty()) return {};
  const StampNs recent = window_ns(record, kRecent);
  for (auto step = seen.rbegin(); step != seen.rend() && agree + contradict < most; ++step) {
    if (seen.back().to_ns - step->to_ns > recent) break;
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

/// Rates, or accelerations, seen and felt.
struct Pairs {
  std::vector<Vector3d> seen, felt;
  double seconds = 0;  ///< of all steps together
};

Pairs rates(const MotionRecord& record, StampNs ahead_ns, StampNs last) {
  Pairs rates;
  for (const SeenStep& step : record.seen())
    if (const auto felt = record.felt(step, ahead_ns); felt && record.seen().back().to_ns - step.to_ns < last) {
      rates.seen.push_back(step.rate_rad_s);
      rates.felt.push_back(felt->rate_rad_s);
      rates.seconds += step.seconds();
    }
  return rates;
}

Vector3d mean(const std::vector<Vector3d>& values) {
  Vector3d sum = Vector3d::Zero();
  for (const Vector3d& v : values) sum += v;
  return sum / static_cast<double>(std::max<std::size_t>(values.size(), 1));
}

struct Fit {
  double factor = 0;   ///< felt over seen
  double squared = 0;  ///< squared correlation, negative where both are opposed
};

/// About the given values. 0 where what was seen has no `least` rms.
Fit fit(const Pairs& pairs, const Vector3d& seen_0, const Vector3d& felt_0, double least) {
  double ss = 0, sf = 0, ff = 0;
  for (std::size_t i = 0; i < pairs.seen.size(); ++i) {
    const Vector3d s = pairs.seen[i] - seen_0, f = pairs.felt[i] - felt_0;
    ss += s.squaredNorm();
    sf += s.dot(f);
    ff += f.squaredNorm();
  }
  if (ss < static_cast<double>(pairs.seen.size()) * least * least || ff <= 0 || sf == 0) return {};
  return {ff / sf, sf * std::abs(sf) / (ss * ff)};
}

Fit fit_at(const MotionRecord& record, StampNs ahead_ns) {
  const Pairs r = rates(record, ahead_ns, kOffsetWindow);
  return r.seen.size() < kFewest ? Fit{} : fit(r, mean(r.seen), mean(r.felt), kFewestRad_s);
}

std::optional<Vector3d> mean_force_between(const MotionRecord& record, StampNs from_ns, StampNs to_ns) {
  Vector3d sum = Vector3d::Zero();
  double seconds = 0;
  for (const SeenStep& step : record.seen()) {
    if (step.to_ns <= from_ns || step.to_ns > to_ns) continue;
    const auto force = felt_force(record, step);
    if (!force) continue;
    sum += step.seconds() * *force;
    seconds += step.seconds();
  }
  if (seconds < kForceSeenS) return std::nullopt;
  return sum / seconds;
}

/// A step as it counts for accelerations.
struct Push {
  StampNs from_ns, to_ns;
  Vector3d moved_m;
  std::optional<Vector3d> force_m_s2;
};

/// The way over the half second before or after a moment, and its force with weights that fall to 0 at the
/// far end: what changes the mean velocity from the one side to the other.
struct Side {
  Vector3d velocity_m_s = Vector3d::Zero(), change_m_s = Vector3d::Zero();
  double seconds = 0;
};

/// `Step`: from the moment on away from it, in time or against it.
template <class Step>
std::optional<Side> side(Step step, Step end, bool after) {
  std::vector<const Push*> steps;
  Side side;
  for (; step != end && side.seconds < kSideS; ++step) {
    const bool gap = !steps.empty() && (after ? steps.back()->to_ns != step->from_ns : steps.back()->from_ns != step->to_ns);
    if (gap || !step->force_m_s2) return std::nullopt;
    steps.push_back(&*step);
    side.seconds += to_seconds(step->to_ns - step->from_ns);
    side.velocity_m_s += step->moved_m;
  }
  if (side.seconds < kSideS) return std::nullopt;
  side.velocity_m_s /= side.seconds;
  double passed_s = 0;
  for (const Push* push : steps) {
    const double dt = to_seconds(push->to_ns - push->from_ns);
    side.change_m_s += dt * (1 - (passed_s + 0.5 * dt) / side.seconds) * *push->force_m_s2;
    passed_s += dt;
  }
  return side;
}

/// Around the ends of the steps; felt with gravity, which is the same in all.
Pairs accelerations(const MotionRecord& record) {
  std::vector<Push> pushes;
  for (const SeenStep& step : record.seen())
    if (record.seen().back().to_ns - step.to_ns < window_ns(record, kSignWindow))
      pushes.push_back({step.from_ns, step.to_ns, step.moved_m, felt_force(record, step)});
  Pairs pairs;
  StampNs first_ns = 0;
  for (std::size_t i = 1; i < pushes.size(); ++i) {
    if (pushes[i - 1].to_ns != pushes[i].from_ns) continue;
    const auto middle = static_cast<std::ptrdiff_t>(i);
    const auto before = side(pushes.rend() - middle, pushes.rend(), false);
    const auto after = side(pushes.begin() + middle, pushes.end(), true);
    if (!before || !after) continue;
    const double seconds = 0.5 * (before->seconds + after->seconds);
    pairs.seen.emplace_back((after->velocity_m_s - before->velocity_m_s) / seconds);
    pairs.felt.emplace_back((before->change_m_s + after->change_m_s) / seconds);
    if (first_ns == 0) first_ns = pushes[i].from_ns;
    pairs.seconds = to_seconds(pushes[i].from_ns - first_ns);
  }
  return pairs;
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

Agreement sign_agreement(const MotionRecord& record) {
  const Pairs pushes = accelerations(record);
  if (pushes.seen.size() < kFewestPushes || pushes.seconds < kPushesSeenS) return Agreement::unknown;
  const Fit found = fit(pushes, mean(pushes.seen), mean(pushes.felt), kFewestM_s2);
  const double factor = std::abs(found.factor);
  if (std::abs(found.squared) < kClearSign || factor > kMostFactor || factor < 1 / kMostFactor)
    return Agreement::unknown;
  return found.squared < 0 ? Agreement::contradicts : Agreement::agrees;
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
