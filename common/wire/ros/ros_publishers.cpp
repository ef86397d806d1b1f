#include "common/wire/ros/ros_publishers.hpp"

#include "common/wire/dds/convert.hpp"
#include "common/wire/dds/opener.hpp"
#include "common/wire/dds/topics.hpp"
#include "common/wire/ros/convert_ros.hpp"
#include "common/wire/sensors/convert_sensors.hpp"

namespace liloc::wire {

RosNames RosNames::of(const std::string& id) {
  return {pose_topic(id),       odometry_topic(id),    kTfTopic, kDiagnosticsTopic, "map",
          wire::odom_frame(id), wire::sensor_frame(id)};
}

Result<RosPublisher> RosPublisher::create(const Participant& participant, const std::string& id,
                                          const RosNames& names) {
  RosPublisher publisher;
  publisher.id_ = id;
  publisher.names_ = names;
  Opener opener(participant, id);
  opener.open<geometry_msgs_msg_dds__PoseWithCovarianceStamped_>(publisher.pose_, names.pose, reliable_qos(8));
  opener.open<nav_msgs_msg_dds__Odometry_>(publisher.odometry_, names.odometry, reliable_qos(8));
  opener.open<tf2_msgs_msg_dds__TFMessage_>(publisher.tf_, names.tf, reliable_qos(100));
  opener.open<diagnostic_msgs_msg_dds__DiagnosticArray_>(publisher.diagnostics_, names.diagnostics,
                                                         reliable_qos(10));
  return opener.finish(std::move(publisher));
}

Status RosPublisher::publish_pose(StampNs stamp_ns, const Pose& T_map_sensor,
                                  const Matrix6d& covariance) const {
  const auto m = pose_message(stamp_ns, names_.world_frame, T_map_sensor, covariance);
  return check(dds_write(pose_.handle(), &m), "write of a pose");
}

Status RosPublisher::publish_odometry(StampNs stamp_ns, const Pose& T_odom_sensor) const {
  nav_msgs_msg_dds__Odometry_ m{};
  m.header = header_of(stamp_ns, names_.odom_frame);
  copy_text(m.child_frame_id, names_.sensor_frame);
  m.pose.pose = ros_pose(T_odom_sensor);
  return check(dds_write(odometry_.handle(), &m), "write of odometry");
}

Status RosPublisher::publish_tf(StampNs stamp_ns, const std::string& parent, const std::string& child,
                                const Pose& T) const {
  std::vector<geometry_msgs_msg_dds__TransformStamped_> transforms(1);
  transforms[0].header = header_of(stamp_ns, parent);
  copy_text(transforms[0].child_frame_id, child);
  const auto pose = ros_pose(T);
  transforms[0].transform = {{pose.position.x, pose.position.y, pose.position.z}, pose.orientation};
  tf2_msgs_msg_dds__TFMessage_ m{};
  lend(m.transforms, transforms);
  return check(dds_write(tf_.handle(), &m), "write of a transform");
}

Status RosPublisher::publish_map_odom(StampNs stamp_ns, const Pose& T_map_odom) const {
  return publish_tf(stamp_ns, names_.world_frame, names_.odom_frame, T_map_odom);
}

Status RosPublisher::publish_odom_sensor(StampNs stamp_ns, const Pose& T_odom_sensor) const {
  return publish_tf(stamp_ns, names_.odom_frame, names_.sensor_frame, T_odom_sensor);
}

Status RosPublisher::publish_diagnosis(StampNs stamp_ns, const Diagnosis& diagnosis) const {
  const auto sample = diagnostics_message(stamp_ns, id_, diagnosis);
  return check(dds_write(diagnostics_.handle(), &sample->message), "write of diagnostics");
}

int RosPublisher::readers() const {
  int readers = 0;
  for (const Entity* writer : {&pose_, &odometry_, &tf_, &diagnostics_}) {
    dds_publication_matched_status_t status{};
    if (dds_get_publication_matched_status(writer->handle(), &status) == DDS_RETCODE_OK)
      readers += static_cast<int>(status.current_count);
  }
  return readers;
}

}  // namespace liloc::wire
