#pragma once
// Private to common/wire: ROS 2's sensor messages from the wire, checked, and to it.
#include <ros2.h>

#include <string>
#include <vector>

#include "common/wire/sensors/sensors.hpp"

namespace liloc::wire {

[[nodiscard]] Result<DepthImage> from_wire(const sensor_msgs_msg_dds__Image_& message, double depth_scale_m);
/// Of the image that is sent: of the rectified one (p) where that is set, of its roi and binned.
[[nodiscard]] Result<Camera> from_wire(const sensor_msgs_msg_dds__CameraInfo_& message);
/// Whether the raw image is distorted: only a rectified one may be used.
[[nodiscard]] bool distorted(const sensor_msgs_msg_dds__CameraInfo_& message);
[[nodiscard]] Result<StampedCloud> from_wire(const sensor_msgs_msg_dds__PointCloud2_& message);
[[nodiscard]] Result<ImuSample> from_wire(const sensor_msgs_msg_dds__Imu_& message);
[[nodiscard]] Result<StampedOdometry> from_wire(const nav_msgs_msg_dds__Odometry_& message);

[[nodiscard]] std_msgs_msg_dds__Header_ header_of(StampNs stamp_ns, const std::string& frame_id);
/// Lends the image's memory, as that of points lends the cloud's.
[[nodiscard]] sensor_msgs_msg_dds__Image_ to_wire(const DepthImage& image, const std::string& frame_id);
sensor_msgs_msg_dds__Image_ to_wire(DepthImage&& image, const std::string& frame_id) = delete;
[[nodiscard]] sensor_msgs_msg_dds__CameraInfo_ to_wire(const Camera& camera, StampNs stamp_ns,
                                                       const std::string& frame_id);
[[nodiscard]] sensor_msgs_msg_dds__Imu_ to_wire(const ImuSample& sample, const std::string& frame_id);

struct PointsSample {
  sensor_msgs_msg_dds__PointCloud2_ message{};
  std::vector<sensor_msgs_msg_dds__PointField_> fields;
};
[[nodiscard]] PointsSample to_wire(const Cloud& cloud_sensor, StampNs stamp_ns, const std::string& frame_id);
PointsSample to_wire(Cloud&& cloud_sensor, StampNs stamp_ns, const std::string& frame_id) = delete;

}  // namespace liloc::wire
