#include "proto-tests/sim/rig.hpp"

#include <cmath>

#include "proto-tests/sim/motion/inertial.hpp"
#include "proto-tests/sim/other_mount.hpp"

namespace liloc::sim {
namespace {

using Eigen::Vector3d;
constexpr double kFromWall_m = 0.35, kFromCeiling_m = 0.05;  // by hand
constexpr double kCarriedHz = 15, kRobotHz = 10;             // as options.hpp says

Camera camera_of(const SimOptions& options) {
  const auto focal = [](int pixels, double fov_deg) { return 0.5 * pixels / std::tan(0.5 * radians(fov_deg)); };
  return {options.image_width,
          options.image_height,
          focal(options.image_width, options.fov_x_deg),
          focal(options.image_height, options.fov_y_deg),
          0.5 * (options.image_width - 1),
          0.5 * (options.image_height - 1),
          options.depth_scale_m};
}

}  // namespace

Pose looking(const Vector3d& from, double azimuth_rad, double down_rad, double roll_rad) {
  const Vector3d forward(std::cos(down_rad) * std::cos(azimuth_rad), std::cos(down_rad) * std::sin(azimuth_rad),
                         -std::sin(down_rad));
  const Vector3d right = forward.cross(Vector3d::UnitZ()).normalized();
  Pose T = Pose::Identity();
  T.linear().col(0) = right;
  T.linear().col(1) = forward.cross(right);
  T.linear().col(2) = forward;
  T.translation() = from;
  T.rotate(Eigen::AngleAxisd(roll_rad, Vector3d::UnitZ()));
  return T;
}

namespace {

struct Mount {
  double x, y, azimuth_rad;
};

/// Corners first, then wall middles; of three the third hangs at a wall's middle.
Mount room_mount(int i, int count, const Vector3d& size) {
  const double w = size.x(), d = size.y(), e = kFromWall_m;
  const Vector3d spots[] = {{e, e, 0},           {w - e, e, 0},   {e, d - e, 0},   {w - e, d - e, 0},
                            {0.5 * w, d - e, 0}, {0.5 * w, e, 0}, {e, 0.5 * d, 0}, {w - e, 0.5 * d, 0}};
  const Vector3d at = count == 3 && i == 2 ? spots[4] : spots[i];
  return {at.x(), at.y(), std::atan2(0.5 * d - at.y(), 0.5 * w - at.x())};
}

/// Evenly along the corridor's middle, by turns looking up and down it.
Mount corridor_mount(int i, int count, const Vector3d& size) {
  const double share = count == 1 ? 0 : static_cast<double>(i) / (count - 1);
  const bool back = i % 2 == 1;
  return {kFromWall_m + share * (size.x() - 2 * kFromWall_m), 0.5 * size.y(),
          share > 0.99 || (back && share > 0.01) ? radians(180) : 0.0};
}

}  // namespace

Site make_site(const SimOptions& options, const Vector3d& size) {
  Random random(options.seed, 20);
  Site site;
  for (int i = 0; i < options.lidars; ++i) {
    const bool corridor = options.kind == SiteKind::corridor;
    const Mount mount =
        corridor ? corridor_mount(i, options.lidars, size) : room_mount(i, options.lidars, size);
    GlobalLidar lidar;
    lidar.id = fmt::format("ceiling{}", i);
    lidar.camera = camera_of(options);
    lidar.rate_hz = options.lidar_rate_hz;
    if (options.world == 2) {
      lidar.T_map_sensor = draw_other_mount(random, i, options.lidars, size);
      site.global_lidars.push_back(std::move(lidar));
      continue;
    }
    lidar.T_map_sensor = looking({mount.x, mount.y, size.z() - kFromCeiling_m},
                                 mount.azimuth_rad + radians(random.uniform(-5, 5)),
                                 radians(random.uniform(28, 32)), radians(random.uniform(-1, 1)));
    site.global_lidars.push_back(std::move(lidar));
  }
  return site;
}

std::vector<DeviceInfo> make_devices(const SimOptions& options) {
  std::vector<DeviceInfo> devices;
  for (int i = 0; i < options.devices; ++i) {
    DeviceInfo device;
    device.id = fmt::format("device{}", i);
    device.camera = camera_of(options);
    device.rate_hz = options.device_kind == DeviceKind::robot ? kRobotHz : kCarriedHz;
    if (options.device_rate_hz > 0) device.rate_hz = options.device_rate_hz;
    device.still_seconds = options.still_seconds;
    if (options.imu_rate_hz > 0) {
      device.imu_rate_hz = options.imu_rate_hz;
      device.T_imu_sensor = mounted_imu();
    }
    devices.push_back(std::move(device));
  }
  return devices;
}

}  // namespace liloc::sim
