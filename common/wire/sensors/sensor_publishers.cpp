#include "common/wire/sensors/sensor_publishers.hpp"

#include "common/wire/dds/convert.hpp"
#include "common/wire/dds/opener.hpp"
#include "common/wire/dds/topics.hpp"
#include "common/wire/sensors/convert_sensors.hpp"

namespace liloc::wire {
namespace {

int readers_of(const Entity& writer) {
  dds_publication_matched_status_t status{};
  return dds_get_publication_matched_status(writer.handle(), &status) < 0
             ? 0
             : static_cast<int>(status.current_count);
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
  if (const auto valid = valid_id(id, "sensor id"); !valid) return tl::unexpected(valid.error());
  return create_at(participant, points_topic(id), sensor_frame(id));
}

Result<PointsPublisher> PointsPublisher::create_at(const Participant& participant, const std::string& topic,
                                                   const std::string& frame_id) {
  PointsPublisher publisher;
  publisher.frame_id_ = frame_id;
  auto writer = make_writer<sensor_msgs_msg_dds__PointCloud2_>(participant.handle(), participant.handle(),
                                                               topic, sensor_qos());
  if (!writer) return tl::unexpected(writer.error());
  publisher.writer_ = std::move(*writer);
  return publisher;
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

}  // namespace liloc::wire
