#include "common/wire/sensors.hpp"

#include "common/wire/convert_sensors.hpp"
#include "common/wire/topics.hpp"
#include "common/wire/typed.hpp"

namespace liloc::wire {

Status subscribe_depth(Dispatcher& dispatcher, const std::string& id, double depth_scale_m,
                       std::function<void(Result<DepthImage>)> handler) {
  return subscribe<sensor_msgs_msg_dds__Image_>(
      dispatcher, {}, depth_topic(id), sensor_qos(),
      [depth_scale_m, handler = std::move(handler)](const auto& message, const auto&) {
        handler(from_wire(message, depth_scale_m));
      });
}

Status subscribe_camera_info(Dispatcher& dispatcher, const std::string& id,
                             std::function<void(Result<Camera>)> handler) {
  return subscribe<sensor_msgs_msg_dds__CameraInfo_>(
      dispatcher, {}, camera_info_topic(id), sensor_qos(),
      [handler = std::move(handler)](const auto& message, const auto&) { handler(from_wire(message)); });
}

Status subscribe_points(Dispatcher& dispatcher, const std::string& id,
                        std::function<void(Result<StampedCloud>)> handler) {
  return subscribe<sensor_msgs_msg_dds__PointCloud2_>(
      dispatcher, {}, points_topic(id), sensor_qos(),
      [handler = std::move(handler)](const auto& message, const auto&) { handler(from_wire(message)); });
}

Status subscribe_imu(Dispatcher& dispatcher, const std::string& id,
                     std::function<void(Result<ImuSample>)> handler) {
  constexpr int kDepth = 256;  // more than a second at 200 Hz: an IMU must not lose what a busy thread delays
  return subscribe<sensor_msgs_msg_dds__Imu_>(
      dispatcher, {}, imu_topic(id), sensor_qos(kDepth),
      [handler = std::move(handler)](const auto& message, const auto&) { handler(from_wire(message)); });
}

}  // namespace liloc::wire
