#pragma once
// What a client tells ROS: where its device is, and how it fares.
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/stamp.hpp"
#include "common/geometry/pose.hpp"
#include "common/wire/dds/entity.hpp"
#include "common/wire/dds/participant.hpp"

namespace liloc::wire {

/// Topics as on the wire, and frames.
struct RosNames {
  std::string pose, odometry, tf, diagnostics;
  std::string world_frame, odom_frame, sensor_frame;
  /// rt/<id>/pose, rt/<id>/odom, rt/tf, rt/diagnostics; map, <id>/odom, <id>/depth_optical_frame.
  [[nodiscard]] static RosNames of(const std::string& id);
};

/// diagnostic_msgs/DiagnosticStatus; its hardware_id is the device's id.
struct Diagnosis {
  enum class Level { ok, warn, error, stale };
  Level level = Level::ok;
  std::string name, message;
  std::vector<std::pair<std::string, std::string>> values;  ///< at most 64
};

/// Any thread.
class RosPublisher {
 public:
  /// Errors: not a valid id, DDS.
  [[nodiscard]] static Result<RosPublisher> create(const Participant& participant, const std::string& id,
                                                   const RosNames& names);
  /// PoseWithCovarianceStamped. `covariance` of T_map_sensor as in SpotReply: sensor frame, [rad; m].
  [[nodiscard]] Status publish_pose(StampNs stamp_ns, const Pose& T_map_sensor,
                                    const Matrix6d& covariance) const;
  [[nodiscard]] Status publish_odometry(StampNs stamp_ns, const Pose& T_odom_sensor) const;
  /// tf of world -> odom.
  [[nodiscard]] Status publish_map_odom(StampNs stamp_ns, const Pose& T_map_odom) const;
  /// tf of odom -> sensor.
  [[nodiscard]] Status publish_odom_sensor(StampNs stamp_ns, const Pose& T_odom_sensor) const;
  [[nodiscard]] Status publish_diagnosis(StampNs stamp_ns, const Diagnosis& diagnosis) const;
  /// Subscribers of the topics that are matched now, all together.
  [[nodiscard]] int readers() const;

 private:
  RosPublisher() = default;
  [[nodiscard]] Status publish_tf(StampNs stamp_ns, const std::string& parent, const std::string& child,
                                  const Pose& T) const;
  std::string id_;
  RosNames names_;
  Entity pose_, odometry_, tf_, diagnostics_;
};

}  // namespace liloc::wire
