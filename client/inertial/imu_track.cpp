#include "client/inertial/imu_track.hpp"

#include <algorithm>
#include <cmath>

#include "client/inertial/imu_range.hpp"
#include "common/base/limited_log.hpp"

namespace liloc {
namespace {

// Of "up" from the nearest sample: drivers that send in batches are that late; by hand.
constexpr double kUpReachS = 0.1;
// Weight of a new sample in the smoothed values that judge stillness; by hand.
constexpr double kQuick = 0.1;
constexpr StampNs kWildFor = from_ms(3000);  // it is told; by hand
// No samples for so long are told; a clipped one leaves the IMU out for so long. By hand.
constexpr StampNs kSilent = from_ms(500), kClippedFor = from_ms(3000);
constexpr double kMostGravityOff = 2.5;                         // m/s^2, as ImuTrust bears; by hand
constexpr double kDoubtTimeConstantS = 0.5, kDoubtSdRad = 0.3;  // of "up" in that time; by hand

}  // namespace

void ImuTrack::find_unit(const ImuSample& sample) {
  if (!unit_.learn(sample.specific_force_m_s2)) return;
  kept_.scale_forces(unit_.factor());
  force_now_ *= unit_.factor();
  force_sum_ *= unit_.factor();
  if (calibrated()) gravity_m_s2_ *= unit_.factor();
}

bool ImuTrack::clips(const ImuSample& sample) const {
  if (kept_.empty()) return false;
  const ImuSample& last = kept_.newest().raw;
  return rate_clips(sample.angular_velocity_rad_s, last.angular_velocity_rad_s) ||
         (!halves_.now() && force_clips(sample.specific_force_m_s2, last.specific_force_m_s2));
}

/// After values at the end of the range "up" is wrong as well, until the accelerometer has drawn it back.
bool ImuTrack::doubtful(StampNs stamp_ns) const {
  return clipped_ns_ != 0 && stamp_ns >= clipped_ns_ && stamp_ns - clipped_ns_ < kClippedFor;
}

std::string ImuTrack::problem(StampNs now_ns) const {
  if (wild_ns_ != 0 && now_ns >= wild_ns_ && now_ns - wild_ns_ < kWildFor)
    return "the IMU says now and then what no such sensor measures (dropped)";
  if (kept_.empty()) return "no IMU samples come";
  const StampNs newest_ns = newest().stamp_ns;
  if (now_ns - newest_ns > kSilent)
    return fmt::format("no IMU samples for {:.1f} s", to_seconds(now_ns - newest_ns));
  const bool halves = halves_.persist(now_ns);
  if (halves && stale()) {
    if (halves_.force_ns() == 0) return "the accelerometer sends nothing but zeros";
    return fmt::format("the accelerometer has stopped: no force for {:.1f} s",
                       to_seconds(newest_ns - halves_.force_ns()));
  }
  if (doubtful(now_ns)) return "the IMU is at the end of its range";
  if (std::string unit = unit_.problem(); !unit.empty()) return unit;
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
  const double most_rate = rate.cwiseAbs().maxCoeff(),
               most_force = unit_.factor() * force.cwiseAbs().maxCoeff();
  if (most_rate <= kMostRate_rad_s && most_force <= kMostForce_m_s2) return {};
  wild_ns_ = sample.stamp_ns - ahead_ns_;
  return fail("IMU sample at {} ns says {:.4g} rad/s and {:.4g} m/s^2, no such sensor measures over {} and {}",
              sample.stamp_ns, most_rate, most_force, kMostRate_rad_s, kMostForce_m_s2);
}

/// What is known of the device stays; what happened between the two clocks is not.
void ImuTrack::set_clock(StampNs by_ns) {
  if (by_ns < 0) log::limited(clock_lines_, "IMU: its clock was set back by {:.1f} s", -to_seconds(by_ns));
  kept_.clear();
  halves_.clock_set();
  first_ns_ += by_ns;
  clipped_ns_ = wild_ns_ = 0;
}

void ImuTrack::take_off(StampNs ahead_ns) {
  ahead_ns_ += ahead_ns;
  kept_.take_off(ahead_ns);
  halves_.take_off(ahead_ns);
  for (StampNs* stamp : {&first_ns_, &clipped_ns_, &wild_ns_})
    if (*stamp != 0) *stamp -= ahead_ns;
}

void ImuTrack::begin_anew(const Eigen::Vector3d& bias_rad_s, const Eigen::Vector3d& up_imu) {
  calibrating_ = false;
  calibrated_s_ = 0;
  bias_ = bias_rad_s;
  // Calibrated from numbers in another unit it was none.
  if (std::abs(gravity_m_s2_ - kStandardGravity) > kMostGravityOff) gravity_m_s2_ = kStandardGravity;
  up_ = up_imu.isZero() ? force_now_.stableNormalized() : up_imu;
  kept_.set_up(up_, bias_);
}

std::optional<StampNs> ImuTrack::newest_ns() const {
  if (kept_.empty()) return std::nullopt;
  return newest().stamp_ns;
}

Status ImuTrack::add(const ImuSample& given) {
  ImuSample sample = given;
  const auto merged = halves_.merge(sample, ahead_ns_, unit_.factor());
  if (merged.force_clips) clipped_ns_ = sample.stamp_ns - ahead_ns_;
  if (!merged.whole) return {};
  if (const Status ok = check(sample); !ok) return ok;
  sample.stamp_ns -= ahead_ns_;
  find_unit(sample);
  sample.specific_force_m_s2 *= unit_.factor();
  if (clips(sample)) clipped_ns_ = sample.stamp_ns;
  const bool stale = halves_.stale(sample.stamp_ns);
  if (!std::exchange(started_, true)) {
    first_ns_ = sample.stamp_ns;
    gyro_now_ = sample.angular_velocity_rad_s;
    force_now_ = sample.specific_force_m_s2;
    up_ = sample.specific_force_m_s2.stableNormalized();
  }
  const double dt = kept_.empty() ? 0 : to_seconds(sample.stamp_ns - newest().stamp_ns);
  gyro_now_ += kQuick * (sample.angular_velocity_rad_s - gyro_now_);
  force_now_ += kQuick * (sample.specific_force_m_s2 - force_now_);
  if (calibrating_) calibrate(sample);
  if (!calibrating_) follow(sample, dt, stale);
  kept_.add({sample, up_, stale}, options_.keep_seconds);
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

bool ImuTrack::covers(StampNs from_ns, StampNs to_ns) const {
  return !doubtful(to_ns) && !up_.isZero() && kept_.covers(from_ns, to_ns);
}

Eigen::Matrix3d ImuTrack::rotation(StampNs from_ns, StampNs to_ns) const {
  return initial_transform(kept_.span(from_ns, to_ns, offsets()), Eigen::Vector3d::Zero()).T_start_end.linear();
}

InertialMotion ImuTrack::motion(StampNs from_ns, StampNs to_ns, const Eigen::Vector3d& velocity_m_s) const {
  return initial_transform(kept_.span(from_ns, to_ns, offsets(), options_.gaussian_sd, options_.average_window),
                           velocity_m_s);
}

std::optional<Eigen::Vector3d> ImuTrack::up(StampNs stamp_ns) const {
  if (kept_.empty()) return std::nullopt;
  const ImuBuffer::Entry& e = kept_.at(stamp_ns);
  const double off_s = to_seconds(stamp_ns - e.raw.stamp_ns);
  if (std::abs(off_s) > kUpReachS || e.up.isZero() || e.stale) return std::nullopt;
  const double dt = std::clamp(off_s, 0.0, to_seconds(kLargestGapNs));
  return so3_exp(-dt * (e.raw.angular_velocity_rad_s - bias_)) * e.up;
}

double ImuTrack::up_sd_rad() const {
  if (!kept_.empty() && doubtful(newest().stamp_ns)) return kDoubtSdRad;
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
