#include "common/testing/box_room.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

namespace liloc::scene {
namespace {

/// Distances along the ray at which it enters and leaves a box.
std::pair<double, double> crossing(const Box& box, const Eigen::Vector3d& from, const Eigen::Vector3d& ray) {
  double enter = -std::numeric_limits<double>::infinity(), leave = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    const double inverse = 1.0 / (std::abs(ray[i]) < 1e-12 ? 1e-12 : ray[i]);
    const double a = (box.low[i] - from[i]) * inverse, b = (box.high[i] - from[i]) * inverse;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return {enter, leave};
}

}  // namespace

BoxRoom furnished_room(unsigned seed) {
  BoxRoom room;
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 9; ++i) {
    const double along = unit(rng), size = 0.3 + 0.5 * unit(rng), height = 0.4 + 1.4 * unit(rng);
    const int wall = i % 4;  // stands against a wall, so that the middle stays free
    const double x = wall == 0 ? 0 : wall == 1 ? 6 - size : along * (6 - size);
    const double y = wall == 2 ? 0 : wall == 3 ? 5 - size : along * (5 - size);
    room.furniture.push_back({{x, y, 0}, {x + size, y + size, height}});
  }
  return room;
}

BoxRoom corridor() {
  return {{{-20, 0, 0}, {20, 2, 2.5}}, {}};
}

Camera small_camera() {
  return {160, 120, 114.0, 114.0, 79.5, 59.5, 0.001};
}

Pose looking(const Eigen::Vector3d& position, double yaw_rad, double down_rad) {
  Eigen::Matrix3d
      level;  // columns: the optical axes x right, y down, z forward of a sensor that looks along map x
  level << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  Pose T = Pose::Identity();
  T.linear() = Eigen::AngleAxisd(yaw_rad, Eigen::Vector3d::UnitZ()).toRotationMatrix() * level *
               Eigen::AngleAxisd(-down_rad, Eigen::Vector3d::UnitX()).toRotationMatrix();
  T.translation() = position;
  return T;
}

DepthImage render(const BoxRoom& room, const Pose& T_map_sensor, const Camera& camera, StampNs stamp_ns,
                  double noise_m, unsigned seed) {
  std::mt19937_64 rng(seed * 1'000'003ULL + static_cast<std::uint64_t>(stamp_ns));
  std::normal_distribution<double> noise(0, noise_m > 0 ? noise_m : 1);
  DepthImage image;
  image.stamp_ns = stamp_ns;
  image.width = camera.width;
  image.height = camera.height;
  image.units.reserve(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height));
  const Eigen::Vector3d from = T_map_sensor.translation();
  for (int v = 0; v < camera.height; ++v)
    for (int u = 0; u < camera.width; ++u) {
      const Eigen::Vector3d ray =
          T_map_sensor.linear() * Eigen::Vector3d((u - camera.cx) / camera.fx, (v - camera.cy) / camera.fy, 1);
      double depth = crossing(room.walls, from, ray).second;
      for (const Box& box : room.furniture) {
        const auto [enter, leave] = crossing(box, from, ray);
        if (enter > 0 && enter < leave) depth = std::min(depth, enter);
      }
      if (noise_m > 0) depth += noise(rng);
      const double units = std::round(depth / camera.depth_scale_m);
      image.units.push_back(units < 0 || units > 65535 ? 0 : static_cast<std::uint16_t>(units));
    }
  return image;
}

std::vector<ImuSample> imu_along(const std::function<Pose(double)>& T_map_sensor, const Pose& T_imu_sensor,
                                 double from_s, double to_s, double rate_hz, StampNs start_ns) {
  constexpr double kStep = 1e-3;  // s, of the differences that rates and forces are
  std::vector<ImuSample> samples;
  const auto T_map_imu = [&](double t) { return T_map_sensor(t) * T_imu_sensor.inverse(); };
  for (int i = 0; from_s + i / rate_hz <= to_s; ++i) {
    const double t = from_s + i / rate_hz;
    const Pose before = T_map_imu(t - kStep), now = T_map_imu(t), after = T_map_imu(t + kStep);
    const Eigen::Vector3d acceleration =
        (after.translation() - 2 * now.translation() + before.translation()) / (kStep * kStep);
    ImuSample sample;
    sample.stamp_ns = start_ns + from_seconds(t);
    sample.angular_velocity_rad_s = so3_log(before.linear().transpose() * after.linear()) / (2 * kStep);
    sample.specific_force_m_s2 = now.linear().transpose() * (acceleration + Eigen::Vector3d(0, 0, 9.81));
    samples.push_back(sample);
  }
  return samples;
}

}  // namespace liloc::scene
