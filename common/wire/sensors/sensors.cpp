#include "common/wire/sensors/sensors.hpp"

#include <algorithm>
#include <cctype>
#include <utility>

#include "common/base/log.hpp"
#include "common/wire/dds/topics.hpp"
#include "common/wire/dds/typed.hpp"
#include "common/wire/sensors/convert_sensors.hpp"

namespace liloc::wire {

namespace {

template <class T, class Out>
Status subscribe_sensor(Dispatcher& dispatcher, const std::string& topic, int depth,
                        std::function<void(Result<Out>)> handler) {
  return subscribe<T>(
      dispatcher, {}, topic, sensor_qos(depth),
      [handler = std::move(handler)](const auto& message, const auto&) { handler(from_wire(message)); });
}

constexpr int kFrames = 5;     // kept for a busy reader, the newest; by hand
constexpr int kSamples = 256;  // more than a second at 200 Hz: none must be lost to what a busy thread delays

}  // namespace

Result<std::string> dds_topic(const std::string& ros_name) {
  const std::string name = ros_name.starts_with('/') ? ros_name.substr(1) : ros_name;
  const auto allowed = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '/' || c == '-'; };
  if (name.empty() || name.size() > 200 || name.ends_with('/') || name.find("//") != std::string::npos ||
      !std::ranges::all_of(name, allowed))
    return fail("topic is \"{}\"; must be a ROS name of letters, digits, _ and /", ros_name);
  return "rt/" + name;
}

Status subscribe_depth_at(Dispatcher& dispatcher, const std::string& topic, double depth_scale_m,
                          std::function<void(Result<DepthImage>)> handler) {
  return subscribe<sensor_msgs_msg_dds__Image_>(
      dispatcher, {}, topic, sensor_qos(kFrames),
      [depth_scale_m, handler = std::move(handler)](const auto& message, const auto&) {
        handler(from_wire(message, depth_scale_m));
      });
}

Status subscribe_camera_info_at(Dispatcher& dispatcher, const std::string& topic,
                                std::function<void(Result<Camera>)> handler) {
  return subscribe<sensor_msgs_msg_dds__CameraInfo_>(
      dispatcher, {}, topic, sensor_qos(kFrames),
      [topic, told = false, handler = std::move(handler)](const auto& message, const auto&) mutable {
        if (distorted(message) && !std::exchange(told, true))
          log::warning(
              "{} tells of distortion: its images are taken for rectified, with {}; use the rectified topic",
              topic, message.p[0] != 0 ? "p as intrinsics" : "k as intrinsics, as p is not set");
        handler(from_wire(message));
      });
}

Status subscribe_points_at(Dispatcher& dispatcher, const std::string& topic,
                           std::function<void(Result<StampedCloud>)> handler) {
  return subscribe_sensor<sensor_msgs_msg_dds__PointCloud2_>(dispatcher, topic, kFrames, std::move(handler));
}

Status subscribe_imu_at(Dispatcher& dispatcher, const std::string& topic,
                        std::function<void(Result<ImuSample>)> handler) {
  return subscribe_sensor<sensor_msgs_msg_dds__Imu_>(dispatcher, topic, kSamples, std::move(handler));
}

Status subscribe_odometry_at(Dispatcher& dispatcher, const std::string& topic,
                             std::function<void(Result<StampedOdometry>)> handler) {
  return subscribe_sensor<nav_msgs_msg_dds__Odometry_>(dispatcher, topic, kSamples, std::move(handler));
}

Status subscribe_depth(Dispatcher& dispatcher, const std::string& id, double depth_scale_m,
                       std::function<void(Result<DepthImage>)> handler) {
  return subscribe_depth_at(dispatcher, depth_topic(id), depth_scale_m, std::move(handler));
}

Status subscribe_camera_info(Dispatcher& dispatcher, const std::string& id,
                             std::function<void(Result<Camera>)> handler) {
  return subscribe_camera_info_at(dispatcher, camera_info_topic(id), std::move(handler));
}

Status subscribe_points(Dispatcher& dispatcher, const std::string& id,
                        std::function<void(Result<StampedCloud>)> handler) {
  return subscribe_points_at(dispatcher, points_topic(id), std::move(handler));
}

Status subscribe_imu(Dispatcher& dispatcher, const std::string& id,
                     std::function<void(Result<ImuSample>)> handler) {
  return subscribe_imu_at(dispatcher, imu_topic(id), std::move(handler));
}

}  // namespace liloc::wire
