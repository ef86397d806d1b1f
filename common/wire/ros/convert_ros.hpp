#pragma once
// Private to the room: what is told to ROS, as its messages.
#include <ros2.h>

#include <memory>

#include "common/wire/ros/ros_publishers.hpp"

namespace liloc::wire {

[[nodiscard]] geometry_msgs_msg_dds__Pose_ ros_pose(const Pose& T);

/// ROS wants [x y z; rotation about the fixed axes of the map]; `covariance` is [rotation; translation] in the
/// sensor's axes.
[[nodiscard]] geometry_msgs_msg_dds__PoseWithCovarianceStamped_ pose_message(StampNs stamp_ns,
                                                                             const std::string& world_frame,
                                                                             const Pose& T_map_sensor,
                                                                             const Matrix6d& covariance);

struct DiagnosticsSample {
  diagnostic_msgs_msg_dds__DiagnosticArray_ message{};
  std::vector<diagnostic_msgs_msg_dds__DiagnosticStatus_> status;
  std::vector<diagnostic_msgs_msg_dds__KeyValue_> values;
};
/// On the heap: the message points into the sample.
[[nodiscard]] std::unique_ptr<DiagnosticsSample> diagnostics_message(StampNs stamp_ns, const std::string& id,
                                                                     const Diagnosis& diagnosis);

}  // namespace liloc::wire
