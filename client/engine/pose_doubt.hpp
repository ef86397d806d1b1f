#pragma once
#include <deque>
#include <optional>

#include "client/odometry/odometry.hpp"
#include "common/geometry/pose_estimate.hpp"
#include "common/protocol/spot.hpp"

namespace liloc {

/// One standard deviation of a motion, along the axis that is known least.
struct MotionSd {
  double rad = 0, m = 0;
};

/// How far the device's pose in the map may be off: as far as the last verified answer, and what odometry may
/// have erred since. Not thread-safe.
class PoseDoubt {
 public:
  /// What speaks against the odometry as of a frame.
  struct Against {
    bool contradicted = false;  ///< its inputs contradict each other persistently
    bool misfit = false;        ///< the frame shows a scene, but not that of the guess
  };
  /// To be called for each frame. `since_asked`: of the motion since the last request (RequestMaker).
  void travelled(StampNs stamp_ns, const OdometryStep& step, const MotionSd& since_asked,
                 const Against& against);
  /// The newest frame became a request's.
  void asked(StampNs stamp_ns);
  /// A verified answer of this segment was taken over.
  void verified(const SpotReply& reply);
  /// The device's clock was set by so much; a new segment begins with the next frame.
  void clock_set(StampNs by_ns);
  /// The pose of the newest frame; empty before the first verified answer.
  [[nodiscard]] std::optional<PoseEstimate> estimate() const;

 private:
  struct Asked {
    StampNs stamp_ns;
    Pose T_odom_sensor;
    MotionSd sd;  ///< of the motion from the request before
  };
  void bridge(StampNs stamp_ns, const OdometryStep& step);

  std::deque<Asked> asked_;                ///< of this segment, by rising stamp
  std::optional<PoseEstimate> last_;       ///< where the last of them, or the segment's begin, was
  Pose T_odom_last_ = Pose::Identity();    ///< and there
  Pose T_odom_sensor_ = Pose::Identity();  ///< of the newest frame
  MotionSd sd_;                            ///< since the last request
  std::uint32_t segment_ = 0;
  StampNs stamp_ns_ = 0, measured_ns_ = 0;  ///< of the newest frame, and of the newest that was measured
  StampNs verified_ns_ = 0;                 ///< of the frame of the newest verified answer
  StampNs misfit_ns_ = 0;                   ///< of the first frame in a row that does not fit; 0: it does
  bool contradicted_ = false;
};

}  // namespace liloc
