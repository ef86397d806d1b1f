#pragma once
#include <deque>
#include <optional>

#include "common/geometry/camera.hpp"

namespace liloc {

/// A stretch between frames as registration measured it.
struct SeenStep {
  StampNs from_ns = 0, to_ns = 0;
  Eigen::Matrix3d R_odom_imu = Eigen::Matrix3d::Identity();  ///< at its end
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero();      ///< mean, IMU axes
  Eigen::Vector3d moved_m = Eigen::Vector3d::Zero();         ///< of the IMU, odometry axes
  [[nodiscard]] double seconds() const { return to_seconds(to_ns - from_ns); }
};

/// What an IMU felt over a stretch, on average, IMU axes.
struct FeltStep {
  Eigen::Vector3d rate_rad_s, force_m_s2;
};

/// The last seconds as an IMU felt them and as registration saw them, for comparison. Not thread-safe.
class MotionRecord {
 public:
  /// Stamps rise; one that does not begins the IMU's side anew.
  void feel(const ImuSample& sample);
  void see(const SeenStep& step);
  /// The IMU's stamps so far were ahead by so much.
  void take_off(StampNs ahead_ns);
  /// The clock of the frames was set.
  void forget_seen() { seen_.clear(); }

  [[nodiscard]] const std::deque<SeenStep>& seen() const { return seen_; }
  /// What was felt during a step if the IMU's stamps are ahead by so much; empty: not all of it is known.
  [[nodiscard]] std::optional<FeltStep> felt(const SeenStep& step, StampNs ahead_ns = 0) const;

 private:
  struct Sum {
    StampNs stamp_ns;
    Eigen::Vector3d turn, push;  ///< integrals since the record began
  };
  [[nodiscard]] std::optional<Sum> at(StampNs stamp_ns) const;

  std::deque<Sum> felt_;
  ImuSample last_;
  std::deque<SeenStep> seen_;
};

}  // namespace liloc
