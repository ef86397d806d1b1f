// Every message that is read from the wire: the bytes, DDS's own decoding, the domain's values.
#include "common/wire/dds/cdr.hpp"
#include "common/wire/sensors/convert_sensors.hpp"
#include "common/wire/spots/convert_spot.hpp"
#include "common/wire/spots/convert_status.hpp"
#include "common/wire/spots/tests/samples.hpp"
#include "proto-tests/fuzz/border.hpp"

namespace liloc::fuzz {
namespace {

constexpr int kDomain = 117;  // one seat, nobody to talk to
constexpr StampNs kStampNs = 1'700'000'000'123'456'789;

const wire::Participant& seat() {
  static const auto participant = wire::Participant::create({.domain = kDomain});
  require(participant.has_value(), "there is no DDS participant on loopback");
  return *participant;
}

/// `check` is given what was taken, and the message.
template <class T, class Convert>
Border border(const char* name, const T& example, Convert convert) {
  auto made = wire::Cdr<T>::create(seat(), example);
  require(made.has_value(), "DDS does not send a seed");
  const auto cdr = std::make_shared<const wire::Cdr<T>>(std::move(*made));
  const auto seed = cdr->encode(example);
  return {
      .name = name, .seeds = {{seed.begin(), seed.end()}}, .read = [cdr, convert](const std::string& bytes) {
        const auto message = cdr->decode({bytes.begin(), bytes.end()});
        if (message == nullptr) return Status(fail("DDS refuses it"));
        return convert(*message);
      }};
}

template <class T>
Status status_of(const Result<T>& result) {
  return result ? Status() : tl::unexpected(result.error());
}

Status read_request(const liloc_msg_SpotRequest& message) {
  const auto request = wire::from_wire(message);
  if (!request) return status_of(request);
  require(request->T_odom_sensor.matrix().allFinite(), "T_odom_sensor is not finite");
  require(wire::to_wire(*request, message.session).has_value(), "the request cannot travel on");
  return {};
}

Status read_reply(const liloc_msg_SpotReply& message) {
  const auto reply = wire::from_wire(message);
  if (!reply) return status_of(reply);
  require(reply->covariance.allFinite(), "the covariance is not finite");
  require(!reply->T_map_odom || reply->T_map_odom->matrix().allFinite(), "T_map_odom is not finite");
  return {};
}

Status read_image(const sensor_msgs_msg_dds__Image_& message) {
  const auto image = wire::from_wire(message, 0.001);
  if (!image) return status_of(image);
  require(image->units.size() == std::size_t{message.width} * message.height, "the image has another size");
  return {};
}

Status read_points(const sensor_msgs_msg_dds__PointCloud2_& message) {
  const auto cloud = wire::from_wire(message);
  if (!cloud) return status_of(cloud);
  for (const auto& p : cloud->cloud_sensor.points) require(p.allFinite(), "a point is not finite");
  return {};
}

nav_msgs_msg_dds__Odometry_ sample_odometry() {
  nav_msgs_msg_dds__Odometry_ message{};
  message.header = wire::header_of(kStampNs, "odom");
  message.pose.pose = {{1, 2, 3}, {0, 0, 0, 1}};
  return message;
}

}  // namespace

std::vector<Border> message_borders() {
  const SpotRequest request = wire::sample_request();
  const wire::RequestSample request_sample = wire::to_wire(request, 1).value();
  const wire::ServerStatus status{"edge1", 1,
                                  2.5,     {{"ceiling0", wire::LidarState::slow, 3.5, 4, 5, "step"}},
                                  6,       7,
                                  8,       9,
                                  10,      {CloudCodec::draco}};
  const wire::StatusSample status_sample = wire::to_wire(status);
  const DepthImage image{kStampNs, 4, 2, {1, 2, 3, 0, 5000, 65535, 7, 8}};
  const Cloud cloud{{{1, 2, 3}, {4, 5, 6}}, {}};
  const wire::PointsSample points = wire::to_wire(cloud, kStampNs, "lidar");
  return {
      border("wire-request", request_sample.message, read_request),
      border("wire-reply", wire::to_wire(wire::sample_reply(), 1), read_reply),
      border("wire-status", status_sample.message,
             [](const liloc_msg_ServerStatus& m) { return status_of(wire::from_wire(m)); }),
      border("ros-image", wire::to_wire(image, "lidar"), read_image),
      border("ros-camera-info", wire::to_wire(Camera{320, 240, 228.5, 230.5, 159.5, 119.5}, kStampNs, "lidar"),
             [](const sensor_msgs_msg_dds__CameraInfo_& m) { return status_of(wire::from_wire(m)); }),
      border("ros-points", points.message, read_points),
      border("ros-imu", wire::to_wire(ImuSample{kStampNs, {0.5, -0.25, 0.125}, {0, 0, 9.75}}, "imu"),
             [](const sensor_msgs_msg_dds__Imu_& m) { return status_of(wire::from_wire(m)); }),
      border("ros-odometry", sample_odometry(),
             [](const nav_msgs_msg_dds__Odometry_& m) { return status_of(wire::from_wire(m)); }),
  };
}

}  // namespace liloc::fuzz
