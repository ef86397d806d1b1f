// What an accelerometer says, beside what registration saw.
#include <cmath>

#include "client/inertial/imu_agreement.hpp"
#include "client/inertial/seen_and_felt.hpp"

namespace liloc {
namespace {

using Eigen::Vector3d;

constexpr StampNs kForceWindow = from_ms(2000);  // of steps whose mean is taken; by hand
constexpr double kForceSeenS = 1;                // of it
constexpr double kGravity = 9.81;                // m/s^2, on Earth
constexpr double kForceOff = 2.5;                // m/s^2: over two seconds nobody gains 5 m/s
constexpr double kForceMoved = 3.5;              // and over twice that nobody both gains and loses as much

constexpr StampNs kSignWindow = from_ms(8000);  // a walk speeds up and slows down in it; by hand
constexpr double kSideS = 0.5;                  // accelerations are means over as much on either side
constexpr std::size_t kFewestPushes = 5;        // that tell a sign; by hand
constexpr double kPushesSeenS = 2;              // from the first of them to the last
constexpr double kFewestM_s2 = 0.05;  // rms of their changes: registration that errs by 2 mm makes it 0.02
constexpr double kClearSign = 0.5;    // squared correlation
constexpr double kMostFactor = 2;     // either way: what is right, or inverted, is as large as what was seen

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
    const bool gap =
        !steps.empty() && (after ? steps.back()->to_ns != step->from_ns : steps.back()->from_ns != step->to_ns);
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
    if (is_recent(record, step, window_ns(record, kSignWindow)))
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

}  // namespace liloc
