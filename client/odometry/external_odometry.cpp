#include "client/odometry/external_odometry.hpp"

#include <algorithm>
#include <cmath>

#include "common/base/limited_log.hpp"

namespace liloc {
namespace {

// In m/s, rad/s: of a pose beyond the samples; by hand.
// Three jumps among a dozen samples are no hiccup; forty that go on forget any number; by hand.
constexpr int kJump = 4, kManyJumps = 10, kMostJumps = 40;
constexpr double kGuessedSpeedError = 0.3, kGuessedTurnError = 0.3;

double share_of(StampNs from_ns, StampNs at_ns, StampNs to_ns) {
  return static_cast<double>(at_ns - from_ns) / static_cast<double>(to_ns - from_ns);
}

/// Standard deviation of what a block of the covariance has grown by; 0 where it has not.
double grown_sd(const Matrix6d& now, const Matrix6d& then, int block) {
  const double growth = (now - then).diagonal().segment<3>(block).maxCoeff();
  return std::sqrt(std::max(0.0, growth));
}

}  // namespace

bool ExternalOdometry::continues(const OdometrySample& from, const OdometrySample& to) const {
  const StampNs gap_ns = to.stamp_ns - from.stamp_ns;
  const double dt = to_seconds(gap_ns);
  return gap_ns <= options_.gap_ns &&
         distance_m(from.T_odom_base, to.T_odom_base) <= options_.discontinuity_m + dt * options_.speed_m_s &&
         angle_between_rad(from.T_odom_base, to.T_odom_base) <=
             options_.discontinuity_rad + dt * options_.turn_rate_rad_s;
}

/// What the device did until the clock of the odometry is known again, nobody knows.
void ExternalOdometry::set_clock(StampNs by_ns) {
  log::limited(clock_lines_, "odometry from outside: its clock was set back by {:.1f} s; a new segment starts",
               -to_seconds(by_ns));
  entries_.clear();
  ++segment_;
}

void ExternalOdometry::jump(const OdometrySample& from, const OdometrySample& to) {
  ++segment_;
  jumps_ = std::min(jumps_ + kJump, kMostJumps);
  jump_m_ = distance_m(from.T_odom_base, to.T_odom_base);
  jump_s_ = to_seconds(to.stamp_ns - from.stamp_ns);
  log::limited(jump_lines_, "odometry from outside: {:.2f} m, {:.1f} deg in {:.2f} s; a new segment starts",
               jump_m_, degrees(angle_between_rad(from.T_odom_base, to.T_odom_base)), jump_s_);
}

std::string ExternalOdometry::problem() const {
  if (jumps_ < kManyJumps) return "";
  return fmt::format(
      "odometry from outside jumps again and again, {:.2f} m in {:.2f} s: it must be in metres and of one "
      "source",
      jump_m_, jump_s_);
}

/// Drivers fill what they do not know with NaN, or -1 as ROS has it.
void ExternalOdometry::know(OdometrySample& sample) {
  if (!sample.covariance) return;
  if (sample.covariance->allFinite() && sample.covariance->diagonal().minCoeff() >= 0) return;
  sample.covariance.reset();
  if (!std::exchange(covariance_told_, true))
    log::warning("odometry from outside: its covariance is not finite or negative; taken for unknown");
}

void ExternalOdometry::frames_clock_set() {
  ++segments_before_;
  ++last_segment_;
}

Status ExternalOdometry::add(const OdometrySample& sample) {
  if (!sample.T_odom_base.matrix().allFinite()) return fail("odometry at {} ns is not finite", sample.stamp_ns);
  const auto set_by_ns = stamps_.add(sample.stamp_ns);
  if (!set_by_ns) return tl::unexpected(set_by_ns.error());
  if (*set_by_ns < 0) set_clock(*set_by_ns);
  if (!entries_.empty() && !continues(entries_.back().sample, sample))
    jump(entries_.back().sample, sample);
  else
    jumps_ = std::max(jumps_ - 1, 0);
  entries_.push_back({sample, segment_});
  know(entries_.back().sample);
  entries_.back().sample.T_odom_base = normalized(sample.T_odom_base);
  while (sample.stamp_ns - entries_.front().sample.stamp_ns > options_.keep_ns) entries_.pop_front();
  return {};
}

void ExternalOdometry::place(const Entry& entry, const Pose& T_odom_base, OdometryStep& step) {
  placed_ = true;
  last_segment_ = segments_before_ + entry.segment;
  T_odom_last_ = T_odom_base * options_.T_base_sensor;
  last_covariance_ = entry.sample.covariance;
  step.T_odom_sensor = T_odom_last_;
  step.segment = last_segment_;
  if (!last_covariance_ || !marked_) return;
  step.sd_rad = grown_sd(*last_covariance_, *marked_, 0);
  step.sd_m = grown_sd(*last_covariance_, *marked_, 3);
}

OdometryStep ExternalOdometry::step(StampNs stamp_ns) {
  OdometryStep step;
  step.source = PoseSource::guess;
  step.converged = false;
  step.T_odom_sensor = T_odom_last_;
  step.segment = last_segment_;
  placed_ = false;
  const auto after =
      std::lower_bound(entries_.begin(), entries_.end(), stamp_ns,
                       [](const Entry& entry, StampNs stamp) { return entry.sample.stamp_ns < stamp; });
  if (after != entries_.end() && after->sample.stamp_ns == stamp_ns) {
    place(*after, after->sample.T_odom_base, step);
  } else if (after != entries_.begin() && after != entries_.end() && after[-1].segment == after->segment) {
    const OdometrySample &a = after[-1].sample, &b = after->sample;
    place(*after, interpolate(a.T_odom_base, b.T_odom_base, share_of(a.stamp_ns, stamp_ns, b.stamp_ns)), step);
  } else if (after != entries_.begin() && stamp_ns - after[-1].sample.stamp_ns <= options_.reach_ns) {
    const Entry& newest = after[-1];
    const bool moving = entries_.begin() + 1 < after && after[-2].segment == newest.segment;
    const OdometrySample &a = moving ? after[-2].sample : newest.sample, &b = newest.sample;
    place(newest,
          moving ? interpolate(a.T_odom_base, b.T_odom_base, share_of(a.stamp_ns, stamp_ns, b.stamp_ns))
                 : b.T_odom_base,
          step);
    const double beyond_s = to_seconds(stamp_ns - b.stamp_ns);
    step.sd_m = std::hypot(step.sd_m, beyond_s * kGuessedSpeedError);
    step.sd_rad = std::hypot(step.sd_rad, beyond_s * kGuessedTurnError);
    return step;
  }
  if (!placed_) return step;
  step.source = PoseSource::external;
  step.converged = true;
  return step;
}

}  // namespace liloc
