#pragma once
// A seeded room under three ceiling LiDARs, and a device that walks in it.
#include <gtest/gtest.h>

#include <memory>

#include "common/codec/codec.hpp"
#include "common/geometry/voxel.hpp"
#include "common/testing/box_room.hpp"
#include "server/localization/localizer.hpp"

namespace liloc {

inline constexpr StampNs kT0 = 1'700'000'000'000'000'000, kStep = from_ms(800);

/// A room under three ceiling LiDARs, and a device that walks in it with its own idea of where odom lies.
struct World {
  explicit World(unsigned seed_in, const LocalizerOptions& options = {}, CellBounds learned = {},
                 std::size_t lidars = 3)
      : seed(seed_in), room(scene::furnished_room(seed_in)) {
    const std::array poses{scene::looking({0.2, 0.2, 2.6}, radians(45), radians(35)),
                           scene::looking({5.8, 0.3, 2.6}, radians(130), radians(35)),
                           scene::looking({3.0, 4.8, 2.6}, radians(-90), radians(35))};
    for (std::size_t i = 0; i < std::min(lidars, poses.size()); ++i)
      site.global_lidars.push_back({"ceiling" + std::to_string(i), scene::small_camera(), 6, poses[i]});
    cloud = std::make_unique<GlobalCloud>(site, global_cloud_options_for(options));
    voxel_size_m = options.voxel_size_m;
    localizer = std::make_unique<Localizer>(*cloud, options, std::move(learned));
  }

  [[nodiscard]] Pose truth(int k) const {
    return scene::looking({2.2 + 0.15 * k, 2.0 + 0.05 * k, 1.2}, 0.8 * seed + 0.12 * k, radians(12));
  }

  void watch(int k) {
    for (std::size_t i = 0; i < site.global_lidars.size(); ++i)
      ASSERT_TRUE(
          cloud->add_depth(i, scene::render(room, site.global_lidars[i].T_map_sensor, scene::small_camera(),
                                            kT0 + k * kStep + from_ms(10), 0.005, seed + 100 + unsigned(i))));
  }

  [[nodiscard]] SpotRequest request(int k, const Pose& T_map_device) const {
    const Camera camera = scene::small_camera();
    SpotRequest r;
    r.client_id = "robot";
    r.seq = static_cast<std::uint64_t>(k) + 1;
    r.stamp_ns = kT0 + k * kStep;
    r.T_odom_sensor = T_map_odom.inverse() * T_map_device;
    r.view = {camera, 0.25, 8.5};
    const auto image = scene::render(room, T_map_device, camera, r.stamp_ns, 0.005, seed);
    r.lpc = *encode(voxel_downsample(*depth_to_cloud(image, camera), voxel_size_m));
    r.up_sensor = T_map_device.linear().transpose() * Eigen::Vector3d::UnitZ();
    return r;
  }

  SpotReply ask(int k) {
    watch(k);
    return localizer->locate(request(k, truth(k)));
  }

  unsigned seed;
  double voxel_size_m = 0.05;
  scene::BoxRoom room;
  Site site;
  std::unique_ptr<GlobalCloud> cloud;
  std::unique_ptr<Localizer> localizer;
  Pose T_map_odom = scene::looking({-3, 2, 0.4}, 2.0);
};

inline bool near(const Pose& a, const Pose& b) {
  return distance_m(a, b) < 0.1 && degrees(angle_between_rad(a, b)) < 3;
}

}  // namespace liloc
