#pragma once
#include "client/src/imu_track.hpp"
#include "common/registration/scan_match.hpp"

namespace liloc {

/// A step from one frame to the next.
struct FrameStep {
  StampNs from_ns = 0, to_ns = 0;
  StampNs anchored_ns = 0;  ///< of the last frame whose pose was measured; the guess gets worse from there
  Pose T_odom_from = Pose::Identity();
};

/// Where the device will be at the next frame: by Algorithm 1 (paper, section 5.1.2) where there are inertial
/// samples, otherwise by constant velocity and turn rate.
class MotionModel {
 public:
  explicit MotionModel(std::optional<Pose> T_imu_sensor) : T_imu_sensor_(std::move(T_imu_sensor)) {}

  /// `imu` may be null.
  [[nodiscard]] MotionGuess guess(const FrameStep& step, const ImuTrack* imu);
  /// The pose that was measured after `guess`, where the one before it was measured too: corrects the velocity.
  void learn(const FrameStep& step, const MotionGuess& guess, const Pose& T_odom_to);
  /// A step that nobody measured and no IMU felt: the motion dies away.
  void fade(const FrameStep& step);
  void halt();

 private:
  [[nodiscard]] MotionGuess by_imu(const FrameStep& step, const ImuTrack& imu);

  std::optional<Pose> T_imu_sensor_;
  bool by_imu_ = false;                                          ///< the last guess was
  Eigen::Vector3d velocity_odom_ = Eigen::Vector3d::Zero();      ///< of the sensor, m/s
  Eigen::Vector3d velocity_imu_odom_ = Eigen::Vector3d::Zero();  ///< of the IMU at the last frame, m/s
  Eigen::Vector3d turn_rate_ = Eigen::Vector3d::Zero();          ///< sensor axes, rad/s
};

}  // namespace liloc
