#include "client/inertial/imu_trust.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/log.hpp"

namespace liloc {
namespace {

constexpr StampNs kStep = from_ms(60);           // over which rotations are compared
constexpr StampNs kLongestStep = from_ms(1500);  // one frame a second, or a little less
// Frames farther apart are matched where the IMU says alone: so many in a row that are not contradict it.
constexpr StampNs kRare = from_ms(400);
constexpr int kUnmatched = 3;                 // by hand, DECISIONS.md
constexpr StampNs kEvery = from_ms(1000);     // an explanation is sought
constexpr StampNs kSignEvery = from_ms(400);  // the force's sign is compared: it takes seconds to show
constexpr StampNs kMostCorrected = from_ms(1000),
                  kSameOffset = from_ms(30);        // of clocks; by hand, DECISIONS.md
constexpr StampNs kFar = from_ms(1000);             // no network delays the one or the other by so much
constexpr StampNs kLongestRetry = from_ms(60'000);  // by hand, DECISIONS.md
constexpr double kGravity = 9.81, kDegrees = 180 / std::numbers::pi;
constexpr double kFactorShare = 0.15;  // by which a factor may differ from a unit's
constexpr double kMostBias = 0.1;      // rad/s; more is no bias

bool is_about(std::optional<double> factor, double unit) {
  return factor && std::abs(*factor / unit - 1) < kFactorShare;
}

std::string apart(StampNs ahead_ns) {
  return fmt::format("IMU stamps are {:.2f} s {} the depth's", std::abs(to_seconds(ahead_ns)),
                     ahead_ns > 0 ? "ahead of" : "behind");
}

}  // namespace

Status ImuTrust::add(const ImuSample& sample) {
  const auto newest_ns = track_.newest_ns();
  if (const Status ok = track_.add(sample); !ok) return ok;
  samples_come_ = true;
  if (track_.newest_ns() != newest_ns && !track_.stale()) record_.feel(track_.newest());
  return {};
}

void ImuTrust::saw(StampNs stamp_ns, const std::optional<Pose>& T_odom_imu, bool unmatched) {
  count_unmatched(stamp_ns - now_ns_, T_odom_imu.has_value(), unmatched);
  now_ns_ = stamp_ns;
  if (track_.newest_ns()) ahead_ns_ = *track_.newest_ns() - stamp_ns;
  const bool come = std::exchange(samples_come_, false);
  far_frames_ = come && far_off() ? far_frames_ + 1 : 0;
  late_frames_ = come && ahead_ns_ < -kLargestGapNs ? late_frames_ + 1 : 0;
  if (!T_odom_imu || (began_ns_ != 0 && stamp_ns - began_ns_ > kLongestStep)) began_ns_ = 0;
  if (T_odom_imu && began_ns_ != 0 && stamp_ns - began_ns_ >= kStep) {
    SeenStep step{began_ns_, stamp_ns, T_odom_imu->linear()};
    step.rate_rad_s = so3_log(T_odom_began_.linear().transpose() * T_odom_imu->linear()) / step.seconds();
    step.moved_m = T_odom_imu->translation() - T_odom_began_.translation();
    record_.see(step);
    began_ns_ = 0;
  }
  if (T_odom_imu && began_ns_ == 0) {
    began_ns_ = stamp_ns;
    T_odom_began_ = *T_odom_imu;
  }
  judge();
}

/// Live, the newest samples are of the newest frame; all that is kept lies on one side of it where they are
/// not. Samples that are ahead lie on both after some seconds, and are as wrong.
bool ImuTrust::far_off() const {
  return std::abs(ahead_ns_) > kFar && (far() || !track_.surrounds(now_ns_));
}

void ImuTrust::count_unmatched(StampNs step_ns, bool measured, bool unmatched) {
  if (measured || step_ns < kRare || believed() == nullptr)
    unmatched_ = 0;
  else if (unmatched)
    ++unmatched_;
}

/// What contradicts; strain where nothing says more than that something does.
ImuTrust::Reason ImuTrust::contradiction() const {
  if (gyro_agreement(record_, track_.gyro_bias_rad_s()) == Agreement::contradicts) return Reason::gyro;
  if (force_agreement(record_) == Agreement::contradicts) return Reason::force;
  if (sign_ == Agreement::contradicts) return Reason::sign;
  return unmatched_ >= kUnmatched ? Reason::strain : Reason::none;
}

void ImuTrust::judge() {
  if (now_ns_ - sign_ns_ >= kSignEvery) {
    sign_ns_ = now_ns_;
    sign_ = sign_agreement(record_);
  }
  // What strains may show itself once the matches are not led by it any more.
  if (reason_ == Reason::none || reason_ == Reason::strain)
    if (const Reason found = contradiction(); found > reason_) leave_out(found);
  if (reason_ == Reason::none && late_frames_ == 0) return;
  if (now_ns_ - explained_ns_ >= kEvery) explain();
  if (reason_ != Reason::none && agrees_again()) believe_again();
}

void ImuTrust::strained() {
  if (reason_ != Reason::none) return;
  leave_out(Reason::strain);
}

void ImuTrust::leave_out(Reason reason) {
  reason_ = reason;
  left_out_ns_ = now_ns_;
  factor_.reset();
  explain();
  log::warning("the IMU is left out: {}", problem());
}

/// A bias that was calibrated from numbers in another unit is none.
Eigen::Vector3d ImuTrust::bias_rad_s() const {
  const Eigen::Vector3d& bias = track_.gyro_bias_rad_s();
  return bias.norm() < kMostBias ? bias : Eigen::Vector3d::Zero();
}

bool ImuTrust::agrees_again() const {
  if (reason_ == Reason::strain && now_ns_ - left_out_ns_ < retry_ns_) return false;
  const Agreement gyro = gyro_agreement(record_, bias_rad_s()), force = force_agreement(record_);
  if (gyro == Agreement::contradicts || force == Agreement::contradicts) return false;
  if (sign_ == Agreement::contradicts) return false;
  switch (reason_) {
    case Reason::gyro:
      return gyro == Agreement::agrees;
    case Reason::force:
      return force == Agreement::agrees;
    default:
      return force == Agreement::agrees && sign_ == Agreement::agrees;
  }
}

void ImuTrust::believe_again() {
  log::info("the IMU agrees with the depth again");
  retry_ns_ = reason_ == Reason::strain ? std::min(2 * retry_ns_, kLongestRetry) : kFirstRetry;
  reason_ = Reason::none;
  offset_.reset();
  begin_anew();
}

void ImuTrust::begin_anew() {
  Eigen::Vector3d up_imu = Eigen::Vector3d::Zero();
  if (const auto force = mean_force_m_s2(record_))
    up_imu = record_.seen().back().R_odom_imu.transpose() * force->normalized();
  track_.begin_anew(bias_rad_s(), up_imu);
}

/// An offset that is found twice in a row is corrected.
void ImuTrust::explain() {
  explained_ns_ = now_ns_;
  if (reason_ == Reason::gyro) factor_ = gyro_factor(record_);
  if (reason_ == Reason::force)
    if (const auto force = mean_force_m_s2(record_)) factor_ = force->norm() / kGravity;
  if (reason_ == Reason::sign) return;  // turns agree, and so do the clocks
  const auto found = stamps_ahead_ns(record_);
  if (!found) return offset_.reset();
  const auto before = std::exchange(offset_, found);
  if (!before || std::abs(*found - *before) > kSameOffset || std::abs(corrected_ns_ + *found) > kMostCorrected)
    return;
  corrected_ns_ += *found;
  track_.take_off(*found);
  record_.take_off(*found);
  offset_.reset();
  late_frames_ = 0;
  log::warning("{}: corrected; stamp both by one clock", apart(corrected_ns_));
  if (reason_ == Reason::none)
    begin_anew();
  else
    believe_again();
}

void ImuTrust::frames_clock_set(StampNs by_ns) {
  record_.forget_seen();
  began_ns_ = 0;
  explained_ns_ += by_ns;
  sign_ns_ += by_ns;
  left_out_ns_ += by_ns;
  now_ns_ += by_ns;
}

std::string ImuTrust::why_left_out() const {
  if (offset_ && std::abs(corrected_ns_ + *offset_) > kMostCorrected)
    return apart(corrected_ns_ + *offset_) + ": over 1 s is not corrected; stamp both by one clock";
  if (reason_ == Reason::gyro && is_about(factor_, kDegrees))
    return "the gyro sends degrees per second in place of rad/s";
  if (reason_ == Reason::gyro && is_about(factor_, 1 / kDegrees))
    return "the gyro's rates are 57.3 times too small: rad/s in place of degrees per second were converted";
  if (reason_ == Reason::force && is_about(factor_, 1 / kGravity))
    return "the accelerometer sends g in place of m/s^2";
  if (reason_ == Reason::force && is_about(factor_, kGravity))
    return "the accelerometer's numbers are 9.81 times too large";
  if (reason_ == Reason::force)
    return fmt::format(
        "the accelerometer contradicts the depth (gravity is {:.1f} m/s^2, or turns with the device): check "
        "its axes and T_imu_sensor",
        kGravity * factor_.value_or(1));
  if (reason_ == Reason::sign)
    return "the accelerometer is upside down: at rest it has to read +g upwards; negate what it sends";
  return "depth and IMU contradict each other: check T_imu_sensor, the stamps of both and the intrinsics";
}

std::string ImuTrust::problem() const {
  if (far()) return apart(ahead_ns_ + corrected_ns_) + ": the IMU is left out; stamp both by one clock";
  if (reason_ != Reason::none) return why_left_out() + " (the IMU is left out)";
  std::string late;
  if (late_frames_ >= kFarFrames)
    late = fmt::format("the newest IMU sample is {:.2f} s older than the frame: it cannot be used",
                       -to_seconds(ahead_ns_));
  if (corrected_ns_ == 0) return late.empty() ? track_.problem(now_ns_) : late;
  return apart(corrected_ns_) + " (corrected)" + (late.empty() ? "" : "; " + late);
}

}  // namespace liloc
