#include "client/inertial/imu_track.hpp"

#include <algorithm>
#include <cmath>

#include "common/base/limited_log.hpp"

namespace liloc {
namespace {

constexpr double kLargestGapS = to_seconds(kLargestGapNs);  // or from a span's end to the next sample
// Of "up" from the nearest sample: drivers that send in batches are that late; by hand.
constexpr double kUpReachS = 0.1;
// Weight of a new sample in the smoothed values that judge stillness; by hand.
constexpr double kQuick = 0.1;
constexpr double kStandardGravity = 9.80665;  // m/s^2, by definition (CGPM 1901)
constexpr int kUnitSamples = 20;              // judge the unit; by hand
// In rad/s and m/s^2; by hand.
constexpr double kLargeRate = 3,
                 kLargeForce = 15;  // a value that stays at exactly one this large is the range's end
// What no such sensor measures: those of phones, robots and depth cameras end at 2000 degrees per second (35
// rad/s) and 16 g (157 m/s^2), or at 32 g (314 m/s^2); twice the turn rate still leaves no sharp frame.
constexpr double kMostRate = 50, kMostForce = 320;
constexpr StampNs kWildFor = from_ms(3000);  // it is told; by hand
// No samples for so long are told; a clipped one leaves the IMU out for so long. By hand.
constexpr StampNs kSilent = from_ms(500), kClippedFor = from_ms(3000);
constexpr StampNs kHalvesFor = from_ms(500);  // is no hiccup; by hand
constexpr StampNs kStale = from_ms(150);      // of a force that is repeated: at 10 Hz one is missing; by hand
constexpr double kMostGravityOff = 2.5;       // m/s^2, as ImuTrust bears; by hand
constexpr double kDoubtTimeConstantS = 0.5, kDoubtSdRad = 0.3;  // of "up" in that time; by hand
// Samples of context for the filters on either side of a span; six standard deviations of the Gaussian filter.
constexpr int kMargin = 12;

}  // namespace

/// Some drivers send g, some convert twice. Nothing that lies on a table or is carried feels 1 m/s^2, or 10 g.
void ImuTrack::find_unit(const ImuSample& sample) {
  if (raw_count_ >= kUnitSamples || sample.specific_force_m_s2.isZero()) return;
  raw_force_sum_ += sample.specific_force_m_s2.norm();
  if (++raw_count_ < kUnitSamples) return;
  const double mean = raw_force_sum_ / raw_count_;
  const bool in_g = mean > 0.7 && mean<1.4, twice = mean> 70 && mean < 140;
  if (!in_g && !twice) return;
  unit_ = in_g ? kStandardGravity : 1 / kStandardGravity;
  log::warning("IMU: a specific force of {:.2f} must be {}; taken times {:.3f}: have the driver send m/s^2",
               mean, in_g ? "in g" : "9.81 times too large", unit_);
  for (Entry& entry : entries_) entry.raw.specific_force_m_s2 *= unit_;
  force_now_ *= unit_;
  force_sum_ *= unit_;
  if (calibrated()) gravity_m_s2_ *= unit_;
}

bool ImuTrack::clips(const ImuSample& sample) const {
  if (entries_.empty()) return false;
  const ImuSample& last = entries_.back().raw;
  for (int axis = 0; axis < 3; ++axis) {
    const double w = sample.angular_velocity_rad_s[axis];
    if (std::abs(w) > kLargeRate && w == last.angular_velocity_rad_s[axis]) return true;
  }
  return !halves_.now && force_clips(sample.specific_force_m_s2, last.specific_force_m_s2);
}

bool ImuTrack::force_clips(const Eigen::Vector3d& force, const Eigen::Vector3d& last) const {
  for (int axis = 0; axis < 3; ++axis)
    if (std::abs(force[axis]) > kLargeForce && force[axis] == last[axis]) return true;
  return false;
}

/// After values at the end of the range "up" is wrong as well, until the accelerometer has drawn it back.
bool ImuTrack::doubtful(StampNs stamp_ns) const {
  return clipped_ns_ != 0 && stamp_ns >= clipped_ns_ && stamp_ns - clipped_ns_ < kClippedFor;
}

std::string ImuTrack::problem(StampNs now_ns) const {
  if (wild_ns_ != 0 && now_ns >= wild_ns_ && now_ns - wild_ns_ < kWildFor)
    return "the IMU says now and then what no such sensor measures (dropped)";
  if (entries_.empty()) return "no IMU samples come";
  if (now_ns - entries_.back().raw.stamp_ns > kSilent)
    return fmt::format("no IMU samples for {:.1f} s", to_seconds(now_ns - entries_.back().raw.stamp_ns));
  const bool halves =
      halves_.newest_ns - halves_.since_ns >= kHalvesFor && now_ns - halves_.newest_ns <= kHalvesFor;
  if (halves && stale()) {
    if (halves_.force_ns == 0) return "the accelerometer sends nothing but zeros";
    return fmt::format("the accelerometer has stopped: no force for {:.1f} s",
                       to_seconds(entries_.back().raw.stamp_ns - halves_.force_ns));
  }
  if (doubtful(now_ns)) return "the IMU is at the end of its range";
  if (unit_ > 1) return "the IMU sends g in place of m/s^2 (corrected)";
  if (unit_ < 1) return "the accelerometer's numbers are 9.81 times too large (corrected)";
  if (!halves) return "";
  return "the IMU sends gyro and accelerometer in messages of their own, with zeros for the other (merged)";
}

Status ImuTrack::check(const ImuSample& sample) {
  const Eigen::Vector3d &rate = sample.angular_velocity_rad_s, &force = sample.specific_force_m_s2;
  if (!rate.allFinite() || !force.allFinite())
    return fail("IMU sample at {} ns is not finite", sample.stamp_ns);
  const auto set_by_ns = stamps_.add(sample.stamp_ns);
  if (!set_by_ns) return tl::unexpected(set_by_ns.error());
  if (*set_by_ns != 0) set_clock(*set_by_ns);
  const double most_rate = rate.cwiseAbs().maxCoeff(), most_force = unit_ * force.cwiseAbs().maxCoeff();
  if (most_rate <= kMostRate && most_force <= kMostForce) return {};
  wild_ns_ = sample.stamp_ns - ahead_ns_;
  return fail("IMU sample at {} ns says {:.4g} rad/s and {:.4g} m/s^2, no such sensor measures over {} and {}",
              sample.stamp_ns, most_rate, most_force, kMostRate, kMostForce);
}

/// What is known of the device stays; what happened between the two clocks is not.
void ImuTrack::set_clock(StampNs by_ns) {
  if (by_ns < 0) log::limited(clock_lines_, "IMU: its clock was set back by {:.1f} s", -to_seconds(by_ns));
  entries_.clear();
  first_ns_ += by_ns;
  clipped_ns_ = wild_ns_ = halves_.force_ns = 0;
}

/// Drivers with a message for each sensor fill the other's part with zeros, which no accelerometer measures:
/// such a sample gets the newest force. False: it was an accelerometer's, and that is all it tells.
bool ImuTrack::merge(ImuSample& sample) {
  Halves& h = halves_;
  const StampNs stamp_ns = sample.stamp_ns - ahead_ns_;
  if (!sample.specific_force_m_s2.isZero()) {
    const bool half = h.now && sample.angular_velocity_rad_s.isZero();
    if (unit_ * sample.specific_force_m_s2.cwiseAbs().maxCoeff() <= kMostForce) {
      if (half && force_clips(unit_ * sample.specific_force_m_s2, unit_ * h.force_m_s2)) clipped_ns_ = stamp_ns;
      h.force_m_s2 = sample.specific_force_m_s2;
      h.force_ns = stamp_ns;
    }
    if (!half) h.now = false;
    return !half;
  }
  if (stamp_ns < h.newest_ns || stamp_ns - h.newest_ns > kHalvesFor) h.since_ns = stamp_ns;
  h.newest_ns = stamp_ns;
  h.now = true;
  sample.specific_force_m_s2 = h.force_m_s2;
  return true;
}

void ImuTrack::take_off(StampNs ahead_ns) {
  ahead_ns_ += ahead_ns;
  for (Entry& entry : entries_) entry.raw.stamp_ns -= ahead_ns;
  for (StampNs* stamp :
       {&first_ns_, &clipped_ns_, &wild_ns_, &halves_.force_ns, &halves_.since_ns, &halves_.newest_ns})
    if (*stamp != 0) *stamp -= ahead_ns;
}

void ImuTrack::begin_anew(const Eigen::Vector3d& bias_rad_s, const Eigen::Vector3d& up_imu) {
  calibrating_ = false;
  calibrated_s_ = 0;
  bias_ = bias_rad_s;
  // Calibrated from numbers in another unit it was none.
  if (std::abs(gravity_m_s2_ - kStandardGravity) > kMostGravityOff) gravity_m_s2_ = kStandardGravity;
  up_ = up_imu.isZero() ? force_now_.stableNormalized() : up_imu;
  Eigen::Vector3d up = up_;
  for (std::size_t i = entries_.size(); i-- > 0;) {
    entries_[i].up = up;
    if (i == 0) break;
    const double dt = to_seconds(entries_[i].raw.stamp_ns - entries_[i - 1].raw.stamp_ns);
    up = so3_exp(dt * (entries_[i].raw.angular_velocity_rad_s - bias_)) * up;
  }
}

std::optional<StampNs> ImuTrack::newest_ns() const {
  if (entries_.empty()) return std::nullopt;
  return entries_.back().raw.stamp_ns;
}

bool ImuTrack::surrounds(StampNs stamp_ns) const {
  return !entries_.empty() && entries_.front().raw.stamp_ns <= stamp_ns &&
         entries_.back().raw.stamp_ns >= stamp_ns;
}

Status ImuTrack::add(const ImuSample& given) {
  ImuSample sample = given;
  if (!merge(sample)) return {};
  if (const Status ok = check(sample); !ok) return ok;
  sample.stamp_ns -= ahead_ns_;
  find_unit(sample);
  sample.specific_force_m_s2 *= unit_;
  if (clips(sample)) clipped_ns_ = sample.stamp_ns;
  const bool stale =
      halves_.now && (halves_.force_ns == 0 || std::abs(sample.stamp_ns - halves_.force_ns) > kStale);
  if (!std::exchange(started_, true)) {
    first_ns_ = sample.stamp_ns;
    gyro_now_ = sample.angular_velocity_rad_s;
    force_now_ = sample.specific_force_m_s2;
    up_ = sample.specific_force_m_s2.stableNormalized();
  }
  const double dt = entries_.empty() ? 0 : to_seconds(sample.stamp_ns - entries_.back().raw.stamp_ns);
  gyro_now_ += kQuick * (sample.angular_velocity_rad_s - gyro_now_);
  force_now_ += kQuick * (sample.specific_force_m_s2 - force_now_);
  if (calibrating_) calibrate(sample);
  if (!calibrating_) follow(sample, dt, stale);
  entries_.push_back({sample, up_, stale});
  while (to_seconds(sample.stamp_ns - entries_.front().raw.stamp_ns) > options_.keep_seconds)
    entries_.pop_front();
  return {};
}

void ImuTrack::calibrate(const ImuSample& sample) {
  const double elapsed = to_seconds(sample.stamp_ns - first_ns_);
  if (count_ > 20) {
    const bool turning = (gyro_now_ - gyro_sum_ / count_).norm() > options_.still_gyro_rad_s ||
                         gyro_now_.norm() > 2 * options_.still_gyro_rad_s;
    const bool pushed = (force_now_ - force_sum_ / count_).norm() > options_.still_accel_m_s2;
    if (turning || pushed) return end_calibration("the device moved");
  }
  if (elapsed > options_.still_seconds) return end_calibration("done");
  gyro_sum_ += sample.angular_velocity_rad_s;
  force_sum_ += sample.specific_force_m_s2;
  count_ += 1;
  calibrated_s_ = elapsed;
  up_ = force_sum_.stableNormalized();
  if (elapsed >= 0.5) {
    bias_ = gyro_sum_ / count_;
    gravity_m_s2_ = force_sum_.norm() / count_;
  }
}

void ImuTrack::end_calibration(const char* why) {
  calibrating_ = false;
  if (calibrated())
    log::info(
        "IMU calibrated over {:.1f} of {:.1f} s ({}): gyro bias {:.4f} {:.4f} {:.4f} rad/s, gravity {:.3f} "
        "m/s^2",
        calibrated_s_, options_.still_seconds, why, bias_.x(), bias_.y(), bias_.z(), gravity_m_s2_);
  else
    log::warning("IMU not calibrated ({} after {:.1f} s): keep the device still at the start; going on without",
                 why, calibrated_s_);
}

/// "Up" turns against the device; a force that is nearly gravity draws it in slowly.
void ImuTrack::follow(const ImuSample& sample, double dt_s, bool stale) {
  const double gravity_off = std::abs(force_now_.norm() - gravity_m_s2_);
  up_ = so3_exp(-dt_s * (sample.angular_velocity_rad_s - bias_)) * up_;
  const bool doubt = doubtful(sample.stamp_ns);
  const double time_constant_s = doubt ? kDoubtTimeConstantS : options_.up_time_constant_s;
  if (!stale && gravity_off < (doubt ? 3 : 1) * options_.up_gate_m_s2)
    up_ += std::min(1.0, dt_s / time_constant_s) * (sample.specific_force_m_s2.stableNormalized() - up_);
  up_ = up_.stableNormalized();
}

std::size_t ImuTrack::first_after(StampNs stamp_ns) const {
  const auto it = std::upper_bound(entries_.begin(), entries_.end(), stamp_ns,
                                   [](StampNs t, const Entry& e) { return t < e.raw.stamp_ns; });
  return static_cast<std::size_t>(it - entries_.begin());
}

bool ImuTrack::covers(StampNs from_ns, StampNs to_ns) const {
  if (entries_.size() < 2 || from_ns >= to_ns || doubtful(to_ns) || up_.isZero()) return false;
  const std::size_t begin = first_after(from_ns), end = first_after(to_ns);
  if (begin == 0 || end == 0) return false;
  if (to_seconds(to_ns - entries_[end - 1].raw.stamp_ns) > kLargestGapS || entries_[end - 1].stale)
    return false;
  for (std::size_t i = begin; i < end; ++i)
    if (to_seconds(entries_[i].raw.stamp_ns - entries_[i - 1].raw.stamp_ns) > kLargestGapS || entries_[i].stale)
      return false;
  return true;
}

std::vector<InertialSample> ImuTrack::span(StampNs from_ns, StampNs to_ns, bool smooth) const {
  const std::size_t begin = first_after(from_ns) - 1, end = first_after(to_ns);
  const std::size_t low = begin - std::min<std::size_t>(begin, kMargin);
  const std::size_t high = std::min(entries_.size(), end + kMargin);
  std::vector<Eigen::Vector3d> rates, forces;
  for (std::size_t i = low; i < high; ++i) {
    rates.push_back(entries_[i].raw.angular_velocity_rad_s - bias_);
    forces.emplace_back(entries_[i].raw.specific_force_m_s2 - gravity_m_s2_ * entries_[i].up);
  }
  if (smooth) forces = moving_average(gaussian_smoothed(forces, options_.gaussian_sd), options_.average_window);
  std::vector<InertialSample> samples;
  for (std::size_t i = begin; i < end; ++i)
    samples.push_back({std::max(entries_[i].raw.stamp_ns, from_ns), rates[i - low], forces[i - low]});
  if (samples.back().stamp_ns < to_ns) {
    samples.push_back(samples.back());
    samples.back().stamp_ns = to_ns;
  }
  return samples;
}

std::vector<ImuSample> ImuTrack::samples(StampNs from_ns, StampNs to_ns) const {
  const std::size_t begin = first_after(from_ns), end = first_after(to_ns);
  const auto at = [&](std::size_t after, StampNs stamp_ns) {
    if (after == entries_.size())
      return ImuSample{stamp_ns, entries_.back().raw.angular_velocity_rad_s,
                       entries_.back().raw.specific_force_m_s2};
    const ImuSample &a = entries_[after - 1].raw, &b = entries_[after].raw;
    const double share = to_seconds(stamp_ns - a.stamp_ns) / to_seconds(b.stamp_ns - a.stamp_ns);
    return ImuSample{stamp_ns, (1 - share) * a.angular_velocity_rad_s + share * b.angular_velocity_rad_s,
                     (1 - share) * a.specific_force_m_s2 + share * b.specific_force_m_s2};
  };
  std::vector<ImuSample> samples{at(begin, from_ns)};
  for (std::size_t i = begin; i < end; ++i) samples.push_back(entries_[i].raw);
  if (samples.back().stamp_ns < to_ns) samples.push_back(at(end, to_ns));
  return samples;
}

Eigen::Matrix3d ImuTrack::rotation(StampNs from_ns, StampNs to_ns) const {
  return initial_transform(span(from_ns, to_ns, false), Eigen::Vector3d::Zero()).T_start_end.linear();
}

InertialMotion ImuTrack::motion(StampNs from_ns, StampNs to_ns, const Eigen::Vector3d& velocity_m_s) const {
  return initial_transform(span(from_ns, to_ns, true), velocity_m_s);
}

std::optional<Eigen::Vector3d> ImuTrack::up(StampNs stamp_ns) const {
  if (entries_.empty()) return std::nullopt;
  const std::size_t after = first_after(stamp_ns);
  const Entry& e = entries_[after == 0 ? 0 : after - 1];
  const double off_s = to_seconds(stamp_ns - e.raw.stamp_ns);
  if (std::abs(off_s) > kUpReachS || e.up.isZero() || e.stale) return std::nullopt;
  const double dt = std::clamp(off_s, 0.0, kLargestGapS);
  return so3_exp(-dt * (e.raw.angular_velocity_rad_s - bias_)) * e.up;
}

double ImuTrack::up_sd_rad() const {
  if (!entries_.empty() && doubtful(entries_.back().raw.stamp_ns)) return kDoubtSdRad;
  return calibrated() ? 0.01 : 0.05;
}

void ImuTrack::observe_rotation(StampNs from_ns, StampNs to_ns, const Eigen::Matrix3d& R_from_to) {
  if (!covers(from_ns, to_ns)) return;
  const double dt = to_seconds(to_ns - from_ns);
  const Eigen::Vector3d rate_error = so3_log(R_from_to.transpose() * rotation(from_ns, to_ns)) / dt;
  if (rate_error.norm() > 0.05) return;  // the match, not the gyro, is off
  bias_ += std::min(1.0, dt / (calibrated() ? 60.0 : 5.0)) * rate_error;
}

}  // namespace liloc
