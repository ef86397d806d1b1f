#pragma once
#include "client/inertial/imu_track.hpp"
#include "client/inertial/inertial_filter.hpp"
#include "client/odometry/motion_doubt.hpp"
#include "common/registration/scan/scan_match.hpp"

namespace liloc {

/// A step from one frame to the next.
struct FrameStep {
  StampNs from_ns = 0, to_ns = 0;
  StampNs anchored_ns = 0;  ///< of the last frame whose pose was measured; the guess gets worse from there
  Pose T_odom_from = Pose::Identity();
};

/// How inertial samples become a guess.
enum class InertialMethod {
  preintegration,  ///< a filter that learns velocity, biases and gravity from the registration
  algorithm1,      ///< the paper's (section 5.1.2): smoothed samples, velocity fed back
};

/// Where the device will be at the next frame, by inertial samples where there are any, otherwise by constant
/// velocity and turn rate.
class MotionModel {
 public:
  explicit MotionModel(std::optional<Pose> T_imu_sensor, InertialMethod method = InertialMethod::preintegration)
      : T_imu_sensor_(std::move(T_imu_sensor)), method_(method) {}

  /// `imu` may be null.
  [[nodiscard]] MotionGuess guess(const FrameStep& step, const ImuTrack* imu);
  /// The same without inertial samples, where those told something different: very much so, or enough to matter
  /// where the guess `failed`.
  [[nodiscard]] std::optional<MotionGuess> rival(const FrameStep& step, const MotionGuess& guess,
                                                 bool failed) const;
  /// The rival was right: what is learned next goes without the samples.
  void take_rival(const FrameStep& step);
  /// The pose that was measured after `guess`, with its covariance (as MotionGuess has it): teaches the motion.
  void learn(const FrameStep& step, const MotionGuess& guess, const MotionGuess& measured);
  /// The device was found without the guess.
  void relocated(const MotionGuess& measured);
  /// A step that nobody measured: what no IMU felt dies away, and what an IMU felt is less sure than it was
  /// while matches corrected it.
  void fade(const FrameStep& step);
  void halt();
  /// The map begins anew where the device is.
  void restart();
  [[nodiscard]] const std::optional<InertialFilter>& filter() const { return filter_; }
  /// Of the newest pose against the map, measured or guessed; axes as MotionGuess has them. A guess's own
  /// covariance is that of the step alone where no filter makes it.
  [[nodiscard]] Matrix6d covariance() const { return doubt_.pose(); }

 private:
  [[nodiscard]] MotionGuess by_imu(const FrameStep& step, const ImuTrack& imu);
  [[nodiscard]] MotionGuess by_algorithm1(const FrameStep& step, const ImuTrack& imu);
  [[nodiscard]] MotionGuess by_preintegration(const FrameStep& step, const ImuTrack& imu);
  [[nodiscard]] MotionGuess by_constant_velocity(const FrameStep& step, const MotionDoubt& doubt) const;
  [[nodiscard]] MotionDoubt doubt_without_imu(const FrameStep& step) const;
  void start_filter(const FrameStep& step, const ImuTrack& imu);
  [[nodiscard]] bool by_filter() const { return by_imu_ && filter_; }

  std::optional<Pose> T_imu_sensor_;
  InertialMethod method_;
  std::optional<InertialFilter> filter_;
  StampNs filter_ns_ = 0;             ///< to which the filter has come
  MotionDoubt doubt_, doubt_before_;  ///< of the newest guess, and of the pose that it started from
  bool stood_still_ = false;
  bool by_imu_ = false;                                          ///< the last guess was
  Eigen::Vector3d velocity_odom_ = Eigen::Vector3d::Zero();      ///< of the sensor, m/s
  Eigen::Vector3d velocity_imu_odom_ = Eigen::Vector3d::Zero();  ///< of the IMU at the last frame, m/s
  Eigen::Vector3d turn_rate_ = Eigen::Vector3d::Zero();          ///< sensor axes, rad/s
};

}  // namespace liloc
