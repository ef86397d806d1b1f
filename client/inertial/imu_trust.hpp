#pragma once
#include <string>

#include "client/inertial/imu_agreement.hpp"
#include "client/inertial/imu_track.hpp"

namespace liloc {

/// An IMU's samples, and whether to believe them: one that contradicts what registration sees is left out until
/// it agrees again. Stamps that are off by up to a second are corrected, by the rotation that both tell. Not
/// thread-safe.
class ImuTrust {
 public:
  explicit ImuTrust(const ImuTrackOptions& options) : track_(options) {}

  /// Errors: ImuTrack's.
  [[nodiscard]] Status add(const ImuSample& sample);
  /// The samples, where they are believed; null otherwise.
  [[nodiscard]] ImuTrack* believed() { return reason_ == Reason::none && !far() ? &track_ : nullptr; }

  /// To be called for each frame; `T_odom_imu` where registration measured it in the axes of the one before.
  /// `unmatched`: the frame shows enough, but was not found where the motion led.
  void saw(StampNs stamp_ns, const std::optional<Pose>& T_odom_imu, bool unmatched = false);
  /// Predictions and matches contradict each other persistently: what the rotation does not show.
  void strained();
  /// The clock of the frames was set by so much.
  void frames_clock_set(StampNs by_ns);
  /// What is wrong with the IMU as of the newest frame, for people; empty: nothing was noticed.
  [[nodiscard]] std::string problem() const;

 private:
  enum class Reason { none, strain, gyro, force, sign };  ///< what says more comes later

  void count_unmatched(StampNs step_ns, bool measured, bool unmatched);
  void judge();
  [[nodiscard]] Reason contradiction() const;
  void leave_out(Reason reason);
  void believe_again();
  void begin_anew();
  [[nodiscard]] bool agrees_again() const;
  void explain();
  [[nodiscard]] Eigen::Vector3d bias_rad_s() const;
  [[nodiscard]] bool far_off() const;
  [[nodiscard]] bool far() const { return far_frames_ >= kFarFrames; }
  [[nodiscard]] std::string why_left_out() const;

  ImuTrack track_;
  MotionRecord record_;
  StampNs now_ns_ = 0;    ///< of the newest frame
  StampNs began_ns_ = 0;  ///< of the stretch that is being seen; 0: none
  Pose T_odom_began_ = Pose::Identity();
  StampNs ahead_ns_ = 0;                  ///< newest sample before the newest frame; negative: behind
  bool samples_come_ = false;             ///< since the frame before
  int far_frames_ = 0, late_frames_ = 0;  ///< in a row
  int unmatched_ = 0;                     ///< likewise, of frames that are rare
  Reason reason_ = Reason::none;
  StampNs left_out_ns_ = 0, retry_ns_ = kFirstRetry;  ///< when, and after how long it is tried again
  std::optional<double> factor_;                      ///< of the gyro or the force, against what was seen
  StampNs explained_ns_ = 0;                          ///< when an explanation was sought last
  Agreement sign_ = Agreement::unknown;               ///< of the force
  StampNs sign_ns_ = 0;                               ///< when it was compared last
  std::optional<StampNs> offset_;                     ///< found then
  StampNs corrected_ns_ = 0;                          ///< taken off the stamps

  static constexpr int kFarFrames = 5;                   // in a row whose samples come late; by hand
  static constexpr StampNs kFirstRetry = from_ms(5000);  // by hand, DECISIONS.md
};

}  // namespace liloc
