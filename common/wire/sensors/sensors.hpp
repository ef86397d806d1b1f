#pragma once
// Sensor streams as ROS 2 names and lays them out; every sample is checked before a handler sees it, and one
// that fails arrives as an error that names the field. Handlers run on the dispatcher's thread.
//
// Topics of sensor <id>: rt/<id>/depth/image_rect_raw, rt/<id>/depth/camera_info, rt/<id>/points, rt/<id>/imu.
#include <functional>
#include <string>

#include "common/geometry/camera.hpp"
#include "common/geometry/cloud.hpp"
#include "common/wire/dds/dispatcher.hpp"

namespace liloc::wire {

struct StampedCloud {
  StampNs stamp_ns = 0;
  Cloud cloud_sensor;
};

/// nav_msgs/Odometry: where a base is in the frame `frame_id`.
struct StampedOdometry {
  StampNs stamp_ns = 0;
  std::string frame_id;
  Pose T_odom_base = Pose::Identity();
  /// [rad; m], axes of the odometry's frame. As it came: drivers that do not know it send 0, -1 or NaN.
  Matrix6d covariance = Matrix6d::Zero();
};

/// A topic as ROS 2 users name it ("/camera/depth/image_raw", with the slash or without) on the wire.
[[nodiscard]] Result<std::string> dds_topic(const std::string& ros_name);

/// 16UC1 comes through in the sensor's own units, 32FC1 (metres) is turned into units of `depth_scale_m`; every
/// missing return is 0.
[[nodiscard]] Status subscribe_depth(Dispatcher& dispatcher, const std::string& id, double depth_scale_m,
                                     std::function<void(Result<DepthImage>)> handler);
/// The camera's depth_scale_m is not part of the message and stays at its default.
[[nodiscard]] Status subscribe_camera_info(Dispatcher& dispatcher, const std::string& id,
                                           std::function<void(Result<Camera>)> handler);
/// Points that are not finite or beyond 1 km are dropped, as ROS marks missing returns with NaN.
[[nodiscard]] Status subscribe_points(Dispatcher& dispatcher, const std::string& id,
                                      std::function<void(Result<StampedCloud>)> handler);
[[nodiscard]] Status subscribe_imu(Dispatcher& dispatcher, const std::string& id,
                                   std::function<void(Result<ImuSample>)> handler);

/// The same from any topic, named as on the wire.
[[nodiscard]] Status subscribe_depth_at(Dispatcher& dispatcher, const std::string& topic, double depth_scale_m,
                                        std::function<void(Result<DepthImage>)> handler);
[[nodiscard]] Status subscribe_camera_info_at(Dispatcher& dispatcher, const std::string& topic,
                                              std::function<void(Result<Camera>)> handler);
[[nodiscard]] Status subscribe_points_at(Dispatcher& dispatcher, const std::string& topic,
                                         std::function<void(Result<StampedCloud>)> handler);
[[nodiscard]] Status subscribe_imu_at(Dispatcher& dispatcher, const std::string& topic,
                                      std::function<void(Result<ImuSample>)> handler);
[[nodiscard]] Status subscribe_odometry_at(Dispatcher& dispatcher, const std::string& topic,
                                           std::function<void(Result<StampedOdometry>)> handler);

}  // namespace liloc::wire
