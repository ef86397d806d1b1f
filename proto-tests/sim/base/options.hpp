#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

#include "common/base/result.hpp"
#include "common/base/stamp.hpp"

namespace liloc::sim {

enum class SiteKind {
  office,     ///< one furnished room, about 10 x 8 x 3.5 m
  corridor,   ///< long and narrow, doors on both sides, little furniture: about 20 x 2.6 x 2.8 m
  symmetric,  ///< an office that looks the same after half a turn: two poses fit every view
  area,       ///< a large hall with pillars and partitions: about 24 x 16 x 4 m
};
enum class DeviceKind {
  carried,  ///< held by a walking person, 1.0 to 1.2 m high
  robot,    ///< fixed height 0.8 m, slow, turns before it drives
};

/// Which sensor a LiDAR or a device behaves as. SENSORS.md says what each was fitted to.
enum class SensorModel {
  l515,       ///< a well-behaved solid-state LiDAR: few losses, even noise
  l515_real,  ///< as two real ones were measured: a third of the pixels, speckle, no dark floor
  kinect,     ///< structured light
  tof,        ///< time of flight, as an Azure Kinect
};

/// What `liloc sim` can be asked for. Every default works; lengths in metres, times in seconds since the start.
struct SimOptions {
  std::uint64_t seed = 1;  ///< everything follows from it: the same options give the same recording
  SiteKind kind = SiteKind::office;
  int world = 1;  ///< whose furniture, people and LiDAR mounts: 1, or 2 as another simulator would draw them
  double width_m = 0, depth_m = 0, height_m = 0;  ///< of the site; 0: drawn by the seed near the kind's size
  double clutter = 1;     ///< scales how much furniture stands about; 0: pillars and partitions alone
  int people = 2;         ///< walking about, without those who carry devices (0..30)
  int moved_items = -1;   ///< furniture moved since the reference scan; -1: half as many as people
  int pushed_items = -1;  ///< furniture pushed during the run; -1: a third as many as people

  int lidars = 3;  ///< ceiling LiDARs (1..8)
  double lidar_rate_hz = 6;
  double lidar_range_m = 9;
  SensorModel lidar_sensor = SensorModel::l515, device_sensor = SensorModel::l515;

  int devices = 1;  ///< 0..16
  DeviceKind device_kind = DeviceKind::carried;
  double device_rate_hz = 0;    ///< 0: 15 carried, 10 robot
  double device_speed_m_s = 0;  ///< while walking; 0: drawn near 0.9 carried, 0.3 robot
  double device_range_m = 6;

  double seconds = 14;       ///< length of the run (up to 3600)
  double still_seconds = 3;  ///< devices stand still for so long at the start
  int image_width = 320, image_height = 240;
  double fov_x_deg = 70, fov_y_deg = 55;
  double depth_scale_m = 0.001;
  double noise = 1;  ///< scales the depth noise of an L515-like sensor; 0: exact depth, no dropouts

  double imu_rate_hz = 200;  ///< 0: devices have no IMU
  double imu_noise = 1;      ///< scales white noise and bias

  double device_clock_offset_ms = 0;                        ///< devices' clocks run ahead by so much
  double ceiling_gap_start_s = 0, ceiling_gap_seconds = 0;  ///< no ceiling frame at all meanwhile
  int blocked_device = 0;                                   ///< this device's view ...
  double blocked_start_s = 0, blocked_seconds = 0;          ///< ... is covered by a hand meanwhile

  int threads = 1;                        ///< for ray casting (1..64)
  std::optional<StampNs> start_stamp_ns;  ///< of time 0; default: 1.7e18 plus 1000 s per seed

  /// Errors name the field and its range.
  [[nodiscard]] Result<SimOptions> validated() const;
};

[[nodiscard]] Result<SiteKind> site_kind_of(std::string_view name);      ///< by the enumerator's name
[[nodiscard]] Result<DeviceKind> device_kind_of(std::string_view name);  ///< by the enumerator's name
/// By its name in options: l515, l515-real, kinect or tof.
[[nodiscard]] Result<SensorModel> sensor_model_of(std::string_view name);

}  // namespace liloc::sim
