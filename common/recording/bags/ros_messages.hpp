#pragma once
// The ROS 2 messages of depth, intrinsics, motion and frames, from CDR to plain values. Pure; nothing in the
// bytes is trusted. Every error is one line without the topic's name, which the caller knows.
#include <string>
#include <string_view>
#include <vector>

#include "common/geometry/camera.hpp"
#include "common/geometry/cloud.hpp"

namespace liloc::bags {

struct Header {
  StampNs stamp_ns = 0;
  std::string frame_id;
};
template <class T>
struct Framed : Header {
  T value;
};
struct Transform {
  std::string parent, child;
  Pose T_parent_child = Pose::Identity();
};

/// Of any message that begins with one.
[[nodiscard]] Result<Header> header_of(std::string_view cdr);
/// sensor_msgs/msg/Image: 16UC1 and mono16 as they are, 32FC1 (metres) in units of `depth_scale_m`.
[[nodiscard]] Result<Framed<DepthImage>> depth_image(std::string_view cdr, double depth_scale_m);
/// sensor_msgs/msg/CameraInfo, as `liloc::camera_of` has it; depth is taken for millimetres, as in ROS.
[[nodiscard]] Result<Framed<Camera>> camera_info(std::string_view cdr);
/// sensor_msgs/msg/Imu.
[[nodiscard]] Result<Framed<ImuSample>> imu(std::string_view cdr);
/// sensor_msgs/msg/PointCloud2 with x, y, z as float32; points that are not finite are left out.
[[nodiscard]] Result<Framed<Cloud>> point_cloud(std::string_view cdr);
/// tf2_msgs/msg/TFMessage.
[[nodiscard]] Result<std::vector<Transform>> transforms(std::string_view cdr);

}  // namespace liloc::bags
