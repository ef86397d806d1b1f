#pragma once
#include <string>

#include "client/include/liloc/client.hpp"
#include "common/base/log.hpp"
#include "common/base/result.hpp"

namespace liloc {

struct DaemonOptions {
  client::Options client;   ///< camera, IMU mounting and still time are set where device_file is empty
  std::string device_file;  ///< device.json; empty: the camera comes from its camera_info topic
  bool ros = false;         ///< find the drivers of this host and tell ROS the pose
  log::Level log_level = log::Level::info;
};

/// `exit_code` is what main returns where there are no options: 0 after --help (the message is then empty), 2
/// for bad usage.
[[nodiscard]] Result<DaemonOptions> parse_arguments(int argc, const char* const* argv, int& exit_code);

/// What device.json says about the device goes into the client's options. Several devices of one kind may share
/// a file.
[[nodiscard]] Status read_device_file(DaemonOptions& options);

}  // namespace liloc
