#include "proto-tests/sim/base/options.hpp"

#include <cmath>

namespace liloc::sim {
namespace {

struct Range {
  const char* field;
  double value, low, high;
};

Status check(const Range& range) {
  if (std::isfinite(range.value) && range.value >= range.low && range.value <= range.high) return {};
  return fail("sim.{} is {}; must be {}..{}", range.field, range.value, range.low, range.high);
}

/// Sizes may be 0, which lets the seed choose.
Status check_or_zero(const Range& range) {
  return range.value == 0 ? Status{} : check(range);
}

}  // namespace

Result<SimOptions> SimOptions::validated() const {
  for (const Range& range :
       {Range{"width_m", width_m, 2, 60}, Range{"depth_m", depth_m, 2, 60},
        Range{"height_m", height_m, 2.2, 12}, Range{"device_rate_hz", device_rate_hz, 1, 60},
        Range{"device_speed_m_s", device_speed_m_s, 0.05, 2}, Range{"imu_rate_hz", imu_rate_hz, 50, 1000}})
    if (auto good = check_or_zero(range); !good) return tl::unexpected(good.error());
  for (const Range& range : {Range{"clutter", clutter, 0, 4},
                             Range{"people", double(people), 0, 30},
                             Range{"moved_items", double(moved_items), -1, 50},
                             Range{"pushed_items", double(pushed_items), -1, 50},
                             Range{"world", double(world), 1, 2},
                             Range{"lidars", double(lidars), 1, 8},
                             Range{"lidar_rate_hz", lidar_rate_hz, 0.5, 60},
                             Range{"lidar_range_m", lidar_range_m, 1, 60},
                             Range{"devices", double(devices), 0, 16},
                             Range{"device_range_m", device_range_m, 1, 60},
                             Range{"seconds", seconds, 0.5, 3600},
                             Range{"still_seconds", still_seconds, 0, 60},
                             Range{"image_width", double(image_width), 16, 1280},
                             Range{"image_height", double(image_height), 16, 1280},
                             Range{"fov_x_deg", fov_x_deg, 10, 120},
                             Range{"fov_y_deg", fov_y_deg, 10, 120},
                             Range{"depth_scale_m", depth_scale_m, 0.0001, 0.01},
                             Range{"noise", noise, 0, 10},
                             Range{"imu_noise", imu_noise, 0, 100},
                             Range{"device_clock_offset_ms", device_clock_offset_ms, -10'000, 10'000},
                             Range{"ceiling_gap_start_s", ceiling_gap_start_s, 0, 3600},
                             Range{"ceiling_gap_seconds", ceiling_gap_seconds, 0, 3600},
                             Range{"blocked_device", double(blocked_device), 0, 15},
                             Range{"blocked_start_s", blocked_start_s, 0, 3600},
                             Range{"blocked_seconds", blocked_seconds, 0, 3600},
                             Range{"threads", double(threads), 1, 64}})
    if (auto good = check(range); !good) return tl::unexpected(good.error());
  if (start_stamp_ns &&
      (*start_stamp_ns < from_ms(10'000) || *start_stamp_ns > StampNs{8'000'000'000'000'000'000}))
    return fail("sim.start_stamp_ns is {}; must be 1e10..8e18", *start_stamp_ns);
  return *this;
}

Result<SiteKind> site_kind_of(std::string_view name) {
  if (name == "office") return SiteKind::office;
  if (name == "corridor") return SiteKind::corridor;
  if (name == "symmetric") return SiteKind::symmetric;
  if (name == "area") return SiteKind::area;
  return fail("sim.kind is '{}'; must be office, corridor, symmetric or area", name);
}

Result<DeviceKind> device_kind_of(std::string_view name) {
  if (name == "carried") return DeviceKind::carried;
  if (name == "robot") return DeviceKind::robot;
  return fail("sim.device_kind is '{}'; must be carried or robot", name);
}

Result<SensorModel> sensor_model_of(std::string_view name) {
  if (name == "l515") return SensorModel::l515;
  if (name == "l515-real") return SensorModel::l515_real;
  if (name == "kinect") return SensorModel::kinect;
  if (name == "tof") return SensorModel::tof;
  return fail("sim: no sensor is called '{}'; must be l515, l515-real, kinect or tof", name);
}

}  // namespace liloc::sim
