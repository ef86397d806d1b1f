#pragma once
// Three ceiling LiDARs in a furnished room, for the tests of this room.
#include <array>
#include <random>

#include "common/testing/box_room.hpp"
#include "server/survey/lidar_scan.hpp"

namespace liloc::survey::test {

constexpr double kVoxel_m = 0.04;

inline std::array<Pose, 3> hung() {
  return {scene::looking({0.3, 0.3, 2.5}, 0.7, 0.7), scene::looking({5.7, 0.4, 2.5}, 2.4, 0.7),
          scene::looking({3.0, 4.7, 2.5}, -1.57, 0.7)};
}

/// What each of them sees, with 3 mm of noise.
inline std::vector<LidarScan> scans(unsigned seed) {
  const auto room = scene::furnished_room(seed);
  std::vector<LidarScan> all;
  for (const Pose& T_map_sensor : hung()) {
    const std::string id = "ceiling" + std::to_string(all.size());
    const auto image = scene::render(room, T_map_sensor, scene::small_camera(), 1 + seed, 0.003);
    all.push_back(make_scan({id, scene::small_camera(), 6, T_map_sensor}, image, kVoxel_m).value());
  }
  return all;
}

/// Off by so much, in a direction and about an axis by the seed.
inline Pose disturbed(const Pose& T, unsigned seed, double shift_m, double turn_rad) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> unit(0, 1);
  const auto direction = [&] { return Eigen::Vector3d(unit(rng), unit(rng), unit(rng)).normalized(); };
  Pose off = T;
  off.linear() = so3_exp(turn_rad * direction()) * T.linear();
  off.translation() += shift_m * direction();
  return off;
}

/// The clouds of all but one, in the map frame.
inline Cloud rest_of(const std::vector<LidarScan>& scans, std::size_t but) {
  Cloud rest;
  for (std::size_t i = 0; i < scans.size(); ++i)
    if (i != but) append(rest, transformed(scans[i].lidar.T_map_sensor, scans[i].cloud));
  return rest;
}

}  // namespace liloc::survey::test
