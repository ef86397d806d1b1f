#pragma once
#include <cstdint>
#include <optional>
#include <string>

#include "client/odometry/local_method.hpp"
#include "common/base/stamp.hpp"
#include "common/geometry/camera.hpp"
#include "common/geometry/pose.hpp"
#include "common/protocol/spot.hpp"

namespace liloc {

/// Defaults are by hand where nothing else is said.
struct EngineOptions {
  std::string client_id;
  Camera camera;
  double min_range_m = 0.25, max_range_m = 8.5;
  double voxel_size_m = 0.05;                ///< paper, section 3.1.5
  StampNs interval_ns = kRequestInterval;    ///< upper bound between global registrations
  StampNs reply_timeout_ns = from_ms(4000);  ///< a request without an answer for so long counts as unanswered
  LocalMethod local = LocalMethod::cloud;
  std::optional<Pose> T_imu_sensor;  ///< there is an IMU exactly where this is set
  double still_seconds = 0;          ///< the device stands still for so long at the start
  bool cold = false;                 ///< each request is to be answered on its own
  std::uint64_t seed = 1;
  bool submap = true;                     ///< send what stands around as well, unless `cold`
  Pose T_base_sensor = Pose::Identity();  ///< with external odometry: the sensor on what the odometry moves
  /// Lower bound between registrations while nothing is verified; 0: a quarter of the interval. Cold: none.
  StampNs searching_interval_ns = 0;
  std::size_t request_bytes = 15'000;    ///< most, of a request's clouds: the surroundings give way first
  CloudCodec codec = CloudCodec::draco;  ///< of a request's clouds
  /// Standard deviations beyond which the device is lost: the paper counts poses off by so much as wrong
  /// (section 3.1.2).
  double lost_sd_m = 0.3, lost_sd_rad = radians(10);
};

}  // namespace liloc
