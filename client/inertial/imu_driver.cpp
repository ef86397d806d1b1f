#include "client/inertial/imu_driver.hpp"

#include <cstdlib>

#include "client/inertial/imu_range.hpp"
#include "common/base/log.hpp"

namespace liloc {
namespace {

constexpr int kUnitSamples = 20;  // judge the unit; by hand
// Nothing that lies on a table or is carried feels 1 m/s^2, or 10 g.
constexpr double kLeastG = 0.7, kMostG = 1.4, kLeastTwice = 70, kMostTwice = 140;
constexpr StampNs kPersist = from_ms(500);  // is no hiccup; by hand
constexpr StampNs kStale = from_ms(150);    // of a force that is repeated: at 10 Hz one is missing; by hand

}  // namespace

bool ForceUnit::learn(const Eigen::Vector3d& force) {
  if (count_ >= kUnitSamples || force.isZero()) return false;
  sum_ += force.norm();
  if (++count_ < kUnitSamples) return false;
  const double mean = sum_ / count_;
  const bool in_g = mean > kLeastG && mean < kMostG;
  const bool twice = mean > kLeastTwice && mean < kMostTwice;
  if (!in_g && !twice) return false;
  factor_ = in_g ? kStandardGravity : 1 / kStandardGravity;
  log::warning("IMU: a specific force of {:.2f} must be {}; taken times {:.3f}: have the driver send m/s^2",
               mean, in_g ? "in g" : "9.81 times too large", factor_);
  return true;
}

std::string ForceUnit::problem() const {
  if (factor_ > 1) return "the IMU sends g in place of m/s^2 (corrected)";
  return factor_ < 1 ? "the accelerometer's numbers are 9.81 times too large (corrected)" : "";
}

SplitMessages::Merged SplitMessages::merge(ImuSample& sample, StampNs ahead_ns, double unit) {
  Merged merged;
  const StampNs stamp_ns = sample.stamp_ns - ahead_ns;
  const Eigen::Vector3d& force = sample.specific_force_m_s2;
  if (!force.isZero()) {
    merged.whole = !now_ || !sample.angular_velocity_rad_s.isZero();
    if (unit * force.cwiseAbs().maxCoeff() <= kMostForce_m_s2) {
      merged.force_clips = !merged.whole && force_clips(unit * force, unit * force_);
      force_ = force;
      force_ns_ = stamp_ns;
    }
    if (merged.whole) now_ = false;
    return merged;
  }
  if (stamp_ns < newest_ns_ || stamp_ns - newest_ns_ > kPersist) since_ns_ = stamp_ns;
  newest_ns_ = stamp_ns;
  now_ = true;
  sample.specific_force_m_s2 = force_;
  return merged;
}

bool SplitMessages::stale(StampNs stamp_ns) const {
  return now_ && (force_ns_ == 0 || std::abs(stamp_ns - force_ns_) > kStale);
}

bool SplitMessages::persist(StampNs now_ns) const {
  return newest_ns_ - since_ns_ >= kPersist && now_ns - newest_ns_ <= kPersist;
}

void SplitMessages::take_off(StampNs ahead_ns) {
  for (StampNs* stamp : {&force_ns_, &since_ns_, &newest_ns_})
    if (*stamp != 0) *stamp -= ahead_ns;
}

}  // namespace liloc
