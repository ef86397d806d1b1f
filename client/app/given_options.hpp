#pragma once
#include <string>
#include <vector>

#include "client/app/options.hpp"

namespace liloc {

/// What the command line or the file gave that is no option yet: names and numbers as they were typed, empty
/// where nothing was.
struct GivenOptions {
  std::string local = "cloud", log_level = "info", codec = "draco";
  std::vector<double> imu_translation, imu_rotation, base_translation, base_rotation;
  std::vector<double> points_view{96, 72, 90, 74};
  std::string depth, camera_info, points, imu, odometry, pose, odom, diagnostics;
  std::string map_frame, odom_frame, sensor_frame;
};

/// Makes options of it, with defaults named after the device. Errors: what does not go together or is out of
/// range, with the option's name.
[[nodiscard]] Status apply(const GivenOptions& given, DaemonOptions& options);

/// Local registration by an IMU needs one; to be asked once the device's file has been read.
[[nodiscard]] Status check_imu(const DaemonOptions& options);

}  // namespace liloc
