#pragma once
#include <string>

#include "client/include/liloc/client.hpp"
#include "common/base/log.hpp"
#include "common/base/result.hpp"
#include "common/wire/ros/ros_publishers.hpp"

namespace liloc {

/// Topics are named as on the wire.
struct SensorTopics {
  std::string depth, camera_info, points, imu;
  std::string odometry;     ///< empty: the client's own
  bool use_points = false;  ///< in place of the depth image
};

struct RosOptions {
  bool enabled = false;  ///< find the drivers of this host and tell ROS the pose
  wire::RosNames names;
  double tf_ahead_ms = 0;                              ///< map -> odom is stamped so far ahead
  double tf_max_speed_m_s = 0, tf_max_turn_deg_s = 0;  ///< of map -> odom; 0: it steps
};

struct DaemonOptions {
  client::Options client;   ///< camera, IMU mounting and still time are set where device_file is empty
  std::string device_file;  ///< device.json; empty: the camera comes from its camera_info topic
  SensorTopics topics;
  RosOptions ros;
  log::Level log_level = log::Level::info;
};

/// `exit_code` is what main returns where there are no options: 0 after --help (the message is then empty), 2
/// for bad usage.
[[nodiscard]] Result<DaemonOptions> parse_arguments(int argc, const char* const* argv, int& exit_code);

/// What device.json says about the device goes into the client's options. Several devices of one kind may share
/// a file.
[[nodiscard]] Status read_device_file(DaemonOptions& options);

}  // namespace liloc
