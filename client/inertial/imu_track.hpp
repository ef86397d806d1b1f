#pragma once
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include "client/inertial/imu_buffer.hpp"
#include "client/inertial/imu_driver.hpp"
#include "client/inertial/sample_stamps.hpp"
#include "common/base/line_limit.hpp"

namespace liloc {

/// Defaults are by hand where nothing else is said.
struct ImuTrackOptions {
  double still_seconds = 0;        ///< the device is said to stand still for so long at the start
  double still_gyro_rad_s = 0.08;  ///< smoothed turn rate above which it does not stand still
  double still_accel_m_s2 = 0.5;   ///< and how far the smoothed specific force may stray from its mean
  double keep_seconds = 4;         ///< memory bound
  double up_time_constant_s = 20;  ///< of the slow correction of "up" by the accelerometer
  double up_gate_m_s2 = 0.4;       ///< samples whose force is off gravity by more do not correct
  double gaussian_sd = 2;          ///< samples (paper, section 5.1.2)
  int average_window = 5;          ///< samples
};

/// The newest inertial samples with gyro bias and the direction of gravity, both calibrated while the device
/// stands still (paper, section 5.1.2); afterwards "up" follows the gyro and is slowly drawn to the
/// accelerometer.
class ImuTrack {
 public:
  explicit ImuTrack(const ImuTrackOptions& options) : options_(options) {}

  /// Errors: a value that is not finite or that no such sensor measures, StampWatch's; the sample is then
  /// ignored.
  [[nodiscard]] Status add(const ImuSample& sample);

  /// The stamps so far, and from now on, are ahead by so much: it is taken off.
  void take_off(StampNs ahead_ns);
  /// The newest sample's force is an older message's, as no newer ones come.
  [[nodiscard]] bool stale() const { return !kept_.empty() && kept_.newest().stale; }
  /// What was known of bias and gravity is replaced; `up_imu`: at the newest sample, zero where it is not
  /// known.
  void begin_anew(const Eigen::Vector3d& bias_rad_s, const Eigen::Vector3d& up_imu);

  /// Empty before any sample.
  [[nodiscard]] std::optional<StampNs> newest_ns() const;
  /// There must be one.
  [[nodiscard]] const ImuSample& newest() const { return kept_.newest().raw; }
  /// Some of what is kept is older and some newer.
  [[nodiscard]] bool surrounds(StampNs stamp_ns) const { return kept_.surrounds(stamp_ns); }
  /// True when samples surround the span closely enough to integrate over it.
  [[nodiscard]] bool covers(StampNs from_ns, StampNs to_ns) const;
  /// R_from_to of the IMU by the gyro. The span must be covered.
  [[nodiscard]] Eigen::Matrix3d rotation(StampNs from_ns, StampNs to_ns) const;
  /// Algorithm 1 over smoothed samples without gravity; velocity in the IMU's axes at `from_ns`. The span must
  /// be covered.
  [[nodiscard]] InertialMotion motion(StampNs from_ns, StampNs to_ns,
                                      const Eigen::Vector3d& velocity_m_s) const;
  /// As they came (in m/s^2), for preintegration; the first and the last lie at the span's ends. The span must
  /// be covered.
  [[nodiscard]] std::vector<ImuSample> samples(StampNs from_ns, StampNs to_ns) const {
    return kept_.samples(from_ns, to_ns);
  }
  /// Unit vector against gravity in IMU axes at a stamp within the last `keep_seconds`; empty where no sample
  /// is near, or the accelerometer says nothing.
  [[nodiscard]] std::optional<Eigen::Vector3d> up(StampNs stamp_ns) const;
  /// One standard deviation of `up`.
  [[nodiscard]] double up_sd_rad() const;

  /// A rotation rate seen by other means (odometry over a span), to which the bias slowly gives way.
  void observe_rotation(StampNs from_ns, StampNs to_ns, const Eigen::Matrix3d& R_from_to);
  /// The device is said to stand still at the start, and the samples agree so far.
  [[nodiscard]] bool still() const { return calibrating_ && count_ > 20; }
  [[nodiscard]] bool calibrated() const { return calibrated_s_ >= 0.5; }
  [[nodiscard]] const Eigen::Vector3d& gyro_bias_rad_s() const { return bias_; }
  /// Mean specific force while the device stood still, IMU axes; meaningful once calibrated.
  [[nodiscard]] Eigen::Vector3d resting_force_m_s2() const { return force_sum_ / std::max(count_, 1.0); }
  /// What is wrong with the samples as of a frame, for people; empty: nothing was noticed.
  [[nodiscard]] std::string problem(StampNs now_ns) const;

 private:
  [[nodiscard]] Status check(const ImuSample& sample);
  void set_clock(StampNs by_ns);
  void find_unit(const ImuSample& sample);
  [[nodiscard]] bool clips(const ImuSample& sample) const;
  [[nodiscard]] bool doubtful(StampNs stamp_ns) const;
  void calibrate(const ImuSample& sample);
  void end_calibration(const char* why);
  void follow(const ImuSample& sample, double dt_s, bool stale);
  [[nodiscard]] ImuBuffer::Offsets offsets() const { return {bias_, gravity_m_s2_}; }

  ImuTrackOptions options_;
  StampWatch stamps_{{"IMU", kClosestSampleNs, kJudgedSamples}};
  LineLimit clock_lines_;  ///< two drivers on one topic take turns
  ImuBuffer kept_;
  bool started_ = false;
  Eigen::Vector3d bias_ = Eigen::Vector3d::Zero(), up_ = Eigen::Vector3d::Zero();
  double gravity_m_s2_ = 9.81;
  ForceUnit unit_;
  SplitMessages halves_;
  StampNs ahead_ns_ = 0;    ///< taken off the stamps
  StampNs clipped_ns_ = 0;  ///< of the newest clipped sample
  StampNs wild_ns_ = 0;     ///< of the newest that no such sensor measures
  bool calibrating_ = true;
  double calibrated_s_ = 0;
  StampNs first_ns_ = 0;
  double count_ = 0;
  Eigen::Vector3d gyro_sum_ = Eigen::Vector3d::Zero(), force_sum_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d gyro_now_ = Eigen::Vector3d::Zero(), force_now_ = Eigen::Vector3d::Zero();  ///< smoothed
};

}  // namespace liloc
