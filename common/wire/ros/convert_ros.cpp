#include "common/wire/ros/convert_ros.hpp"

#include "common/wire/dds/convert.hpp"
#include "common/wire/sensors/convert_sensors.hpp"

namespace liloc::wire {
namespace {

constexpr std::size_t kMostValues = 64;  // as idl/ros2.idl has it

}  // namespace

geometry_msgs_msg_dds__Pose_ ros_pose(const Pose& T) {
  const Eigen::Quaterniond q(T.linear());
  return {{T.translation().x(), T.translation().y(), T.translation().z()}, {q.x(), q.y(), q.z(), q.w()}};
}

geometry_msgs_msg_dds__PoseWithCovarianceStamped_ pose_message(StampNs stamp_ns, const std::string& world_frame,
                                                               const Pose& T_map_sensor,
                                                               const Matrix6d& covariance) {
  Matrix6d J = Matrix6d::Zero();
  J.block<3, 3>(0, 3) = T_map_sensor.linear();
  J.block<3, 3>(3, 0) = T_map_sensor.linear();
  geometry_msgs_msg_dds__PoseWithCovarianceStamped_ m{};
  m.header = header_of(stamp_ns, world_frame);
  m.pose.pose = ros_pose(T_map_sensor);
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(m.pose.covariance).noalias() =
      J * covariance * J.transpose();
  return m;
}

std::unique_ptr<DiagnosticsSample> diagnostics_message(StampNs stamp_ns, const std::string& id,
                                                       const Diagnosis& diagnosis) {
  auto sample = std::make_unique<DiagnosticsSample>();
  for (const auto& [key, value] : diagnosis.values) {
    if (sample->values.size() == kMostValues) break;
    auto& entry = sample->values.emplace_back();
    copy_text(entry.key, key);
    copy_text(entry.value, value);
  }
  auto& status = sample->status.emplace_back();
  status.level = static_cast<std::uint8_t>(diagnosis.level);
  copy_text(status.name, diagnosis.name);
  copy_text(status.message, diagnosis.message);
  copy_text(status.hardware_id, id);
  lend(status.values, sample->values);
  sample->message.header = header_of(stamp_ns, "");
  lend(sample->message.status, sample->status);
  return sample;
}

}  // namespace liloc::wire
