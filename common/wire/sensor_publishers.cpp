#include "common/wire/sensor_publishers.hpp"

#include "common/base/ids.hpp"
#include "common/wire/convert.hpp"
#include "common/wire/convert_sensors.hpp"
#include "common/wire/topics.hpp"
#include "common/wire/typed.hpp"

namespace liloc::wire {
namespace {

int readers_of(const Entity& writer) {
  dds_publication_matched_status_t status{};
  return dds_get_publication_matched_status(writer.handle(), &status) < 0
             ? 0
             : static_cast<int>(status.current_count);
}

/// Opens the writers of a publisher one after the other; the first error stays.
class Opener {
 public:
  Opener(const Participant& participant, const std::string& id) : participant_(participant.handle()) {
    if (auto valid = valid_id(id, "sensor id"); !valid) status_ = tl::unexpected(valid.error());
  }
  template <class T>
  void open(Entity& writer, const std::string& topic, Qos qos) {
    if (!status_) return;
    auto made = make_writer<T>(participant_, participant_, topic, std::move(qos));
    if (made)
      writer = std::move(*made);
    else
      status_ = tl::unexpected(made.error());
  }
  template <class Publisher>
  Result<Publisher> finish(Publisher publisher) {
    if (!status_) return tl::unexpected(status_.error());
    return publisher;
  }

 private:
  std::int32_t participant_;
  Status status_;
};

geometry_msgs_msg_dds__Quaternion_ quaternion_of(const Pose& T) {
  const Eigen::Quaterniond q(T.linear());
  return {q.x(), q.y(), q.z(), q.w()};
}

geometry_msgs_msg_dds__Pose_ pose_of(const Pose& T) {
  return {{T.translation().x(), T.translation().y(), T.translation().z()}, quaternion_of(T)};
}

/// ROS: [x y z; rotation about the fixed axes]; ours: [rotation; translation] in the sensor's axes.
void fill_covariance(double (&to)[36], const Pose& T_map_sensor, const Matrix6d& covariance) {
  Matrix6d J = Matrix6d::Zero();
  J.block<3, 3>(0, 3) = T_map_sensor.linear();
  J.block<3, 3>(3, 0) = T_map_sensor.linear();
  Eigen::Map<Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(to).noalias() = J * covariance * J.transpose();
}

}  // namespace

Result<DepthPublisher> DepthPublisher::create(const Participant& participant, const std::string& id,
                                              const Camera& camera) {
  const auto valid = camera.validated(id);
  if (!valid) return tl::unexpected(valid.error());
  DepthPublisher publisher;
  publisher.frame_id_ = sensor_frame(id);
  publisher.camera_ = *valid;
  Opener opener(participant, id);
  opener.open<sensor_msgs_msg_dds__Image_>(publisher.image_, depth_topic(id), sensor_qos());
  opener.open<sensor_msgs_msg_dds__CameraInfo_>(publisher.info_, camera_info_topic(id), sensor_qos());
  return opener.finish(std::move(publisher));
}

Status DepthPublisher::publish(const DepthImage& image) const {
  const auto pixels = static_cast<std::size_t>(camera_.width) * static_cast<std::size_t>(camera_.height);
  if (image.width != camera_.width || image.height != camera_.height || image.units.size() != pixels)
    return fail("depth image is {} x {} with {} values, {}'s camera is {} x {}", image.width, image.height,
                image.units.size(), frame_id_, camera_.width, camera_.height);
  const auto info = to_wire(camera_, image.stamp_ns, frame_id_);
  if (auto written = check(dds_write(info_.handle(), &info), "write of camera_info"); !written) return written;
  const auto message = to_wire(image, frame_id_);
  return check(dds_write(image_.handle(), &message), "write of a depth image");
}

int DepthPublisher::readers() const {
  return readers_of(image_);
}

Result<PointsPublisher> PointsPublisher::create(const Participant& participant, const std::string& id) {
  PointsPublisher publisher;
  publisher.frame_id_ = sensor_frame(id);
  Opener opener(participant, id);
  opener.open<sensor_msgs_msg_dds__PointCloud2_>(publisher.writer_, points_topic(id), sensor_qos());
  return opener.finish(std::move(publisher));
}

Status PointsPublisher::publish(StampNs stamp_ns, const Cloud& cloud_sensor) const {
  const auto sample = to_wire(cloud_sensor, stamp_ns, frame_id_);
  return check(dds_write(writer_.handle(), &sample.message), "write of points");
}

int PointsPublisher::readers() const {
  return readers_of(writer_);
}

Result<ImuPublisher> ImuPublisher::create(const Participant& participant, const std::string& id) {
  ImuPublisher publisher;
  publisher.frame_id_ = id + "/imu";
  Opener opener(participant, id);
  opener.open<sensor_msgs_msg_dds__Imu_>(publisher.writer_, imu_topic(id), sensor_qos(256));
  return opener.finish(std::move(publisher));
}

Status ImuPublisher::publish(const ImuSample& sample) const {
  const auto message = to_wire(sample, frame_id_);
  return check(dds_write(writer_.handle(), &message), "write of an IMU sample");
}

int ImuPublisher::readers() const {
  return readers_of(writer_);
}

Result<PosePublisher> PosePublisher::create(const Participant& participant, const std::string& id,
                                            const std::string& world_frame) {
  PosePublisher publisher;
  publisher.world_frame_ = world_frame;
  publisher.odom_frame_ = odom_frame(id);
  publisher.sensor_frame_ = sensor_frame(id);
  Opener opener(participant, id);
  opener.open<geometry_msgs_msg_dds__PoseWithCovarianceStamped_>(publisher.pose_, pose_topic(id),
                                                                 reliable_qos(8));
  opener.open<nav_msgs_msg_dds__Odometry_>(publisher.odometry_, odometry_topic(id), reliable_qos(8));
  opener.open<tf2_msgs_msg_dds__TFMessage_>(publisher.tf_, kTfTopic, reliable_qos(100));
  return opener.finish(std::move(publisher));
}

Status PosePublisher::publish_pose(StampNs stamp_ns, const Pose& T_map_sensor,
                                   const Matrix6d& covariance) const {
  geometry_msgs_msg_dds__PoseWithCovarianceStamped_ m{};
  m.header = header_of(stamp_ns, world_frame_);
  m.pose.pose = pose_of(T_map_sensor);
  fill_covariance(m.pose.covariance, T_map_sensor, covariance);
  return check(dds_write(pose_.handle(), &m), "write of a pose");
}

Status PosePublisher::publish_odometry(StampNs stamp_ns, const Pose& T_odom_sensor) const {
  nav_msgs_msg_dds__Odometry_ m{};
  m.header = header_of(stamp_ns, odom_frame_);
  copy_text(m.child_frame_id, sensor_frame_);
  m.pose.pose = pose_of(T_odom_sensor);
  return check(dds_write(odometry_.handle(), &m), "write of odometry");
}

Status PosePublisher::publish_tf(StampNs stamp_ns, const std::optional<Pose>& T_map_odom,
                                 const Pose& T_odom_sensor) const {
  std::vector<geometry_msgs_msg_dds__TransformStamped_> transforms;
  const auto add = [&](const std::string& parent, const std::string& child, const Pose& T) {
    auto& m = transforms.emplace_back();
    m.header = header_of(stamp_ns, parent);
    copy_text(m.child_frame_id, child);
    m.transform = {{T.translation().x(), T.translation().y(), T.translation().z()}, quaternion_of(T)};
  };
  if (T_map_odom) add(world_frame_, odom_frame_, *T_map_odom);
  add(odom_frame_, sensor_frame_, T_odom_sensor);
  tf2_msgs_msg_dds__TFMessage_ m{};
  lend(m.transforms, transforms);
  return check(dds_write(tf_.handle(), &m), "write of transforms");
}

}  // namespace liloc::wire
