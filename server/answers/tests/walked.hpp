#pragma once
// A walk in a seeded room, and all answers with what they rested on.
#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <vector>

#include "common/codec/codec.hpp"
#include "common/geometry/voxel.hpp"
#include "common/testing/box_room.hpp"
#include "server/localization/answered.hpp"

namespace liloc::answers {

struct WalkedWorld {
  static constexpr StampNs kT0 = 1'700'000'000'000'000'000, kStep = from_ms(800);

  WalkedWorld(unsigned seed_in, AnswerSink sink) : seed(seed_in), room(scene::furnished_room(seed_in)) {
    const std::array poses{scene::looking({0.2, 0.2, 2.6}, radians(45), radians(35)),
                           scene::looking({5.8, 0.3, 2.6}, radians(130), radians(35))};
    for (std::size_t i = 0; i < poses.size(); ++i)
      site.global_lidars.push_back({"ceiling" + std::to_string(i), scene::small_camera(), 6, poses[i]});
    cloud = std::make_unique<GlobalCloud>(site, global_cloud_options_for({}));
    localizer = std::make_unique<Localizer>(*cloud, LocalizerOptions{}, CellBounds{}, std::move(sink));
  }
  [[nodiscard]] Pose truth(int k) const {
    return scene::looking({2.2 + 0.15 * k, 2.0 + 0.05 * k, 1.2}, 0.8 * seed + 0.12 * k, radians(12));
  }
  void watch(int k) const {
    for (std::size_t i = 0; i < site.global_lidars.size(); ++i)
      ASSERT_TRUE(cloud->add_depth(
          i, scene::render(room, site.global_lidars[i].T_map_sensor, scene::small_camera(),
                           kT0 + k * kStep + from_ms(10), 0.005, seed + 100 + unsigned(i) + 10 * unsigned(k))));
    cloud->prepare();
  }
  [[nodiscard]] SpotRequest request(int k, const Pose& T_map_device) const {
    SpotRequest r;
    r.client_id = "robot";
    r.seq = static_cast<std::uint64_t>(k) + 1;
    r.stamp_ns = kT0 + k * kStep;
    r.T_odom_sensor = T_map_device;
    r.view = {scene::small_camera(), 0.25, 8.5};
    const auto image = scene::render(room, T_map_device, r.view.camera, r.stamp_ns, 0.005, seed);
    r.lpc = *encode(voxel_downsample(*depth_to_cloud(image, r.view.camera), 0.05));
    r.up_sensor = T_map_device.linear().transpose() * Eigen::Vector3d::UnitZ();
    return r;
  }

  unsigned seed;
  scene::BoxRoom room;
  Site site;
  std::unique_ptr<GlobalCloud> cloud;
  std::unique_ptr<Localizer> localizer;
};

struct Walked {
  explicit Walked(unsigned seed, int spots)
      : world(seed, [this](Answered answered) { answers.push_back(std::move(answered)); }) {
    for (int k = 0; k < spots; ++k) {
      world.watch(k);
      (void)world.localizer->locate(world.request(k, world.truth(k)));
    }
  }
  Walked(const Walked&) = delete;
  Walked& operator=(const Walked&) = delete;

  std::vector<Answered> answers;
  WalkedWorld world;
};

}  // namespace liloc::answers
