#include "server/global_cloud/snapshot.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

constexpr StampNs kT0 = 1'700'000'000'000'000'000;

/// 64 x 48 pixels, 2 m before a wall at 4 m in columns from..to.
DepthImage with_visitor(int from, int to) {
  DepthImage image{kT0, 64, 48, std::vector<std::uint16_t>(64 * 48, 4000)};
  for (int v = 0; v < 48; ++v)
    for (int u = from; u < to; ++u) image.units[static_cast<std::size_t>(v * 64 + u)] = 2000;
  return image;
}

GlobalLidar lidar() {
  return {"ceiling0", {64, 48, 50.0, 50.0, 31.5, 23.5, 0.001}, 6, Pose::Identity()};
}

/// Of the room's points at 2 m, those that are stale.
double stale_share(const Snapshot& snapshot) {
  int near = 0, stale = 0;
  const Target& target = snapshot.target();
  for (std::size_t i = 0; i < target->coarse.size(); ++i)
    if (target->coarse.points[i].z() < 3) ++near, stale += target.dynamic->stale[i];
  EXPECT_GT(near, 5);
  return static_cast<double>(stale) / near;
}

class SnapshotTest : public testing::Test {
 protected:
  std::shared_ptr<const LidarSurfaces> surfaces(DepthImage image) const {
    return std::make_shared<const LidarSurfaces>(std::move(image), lidar_, options_);
  }
  Snapshot snapshot(Layers layers, const std::shared_ptr<const LidarSurfaces>& now,
                    const std::shared_ptr<const LidarSurfaces>& of_room) const {
    return {{std::make_shared<const LidarFrame>(std::move(layers), now, lidar_, options_)},
            std::make_shared<const StitchedRoom>(StitchedRoom::Parts{of_room}, options_)};
  }

  const GlobalLidar lidar_ = lidar();
  const SnapshotOptions options_;
  const DepthImage nothing_{kT0, 64, 48, std::vector<std::uint16_t>(64 * 48, 0)};
};

TEST_F(SnapshotTest, WhatAFrameFindsNoMoreIsStale) {
  const auto room = surfaces(with_visitor(20, 30));
  DepthImage gone = with_visitor(20, 30);
  for (std::uint16_t& units : gone.units) units = units == 2000 ? units : 0;
  EXPECT_EQ(stale_share(snapshot({with_visitor(20, 30), {}, {}}, room, room)), 0);
  EXPECT_EQ(stale_share(snapshot({nothing_, {}, gone}, room, room)), 1);
}

TEST_F(SnapshotTest, WhatOnlyAnOlderRoomHasIsStaleUntilItIsIndexedAnew) {
  const auto with = surfaces(with_visitor(20, 30));
  DepthImage image = with_visitor(20, 30);
  for (std::uint16_t& units : image.units) units = units == 2000 ? std::uint16_t{0} : units;
  const auto without = surfaces(image), farther = surfaces(with_visitor(0, 0));
  EXPECT_EQ(stale_share(snapshot({nothing_, {}, {}}, without, with)), 1) << "nothing returns behind him";
  EXPECT_EQ(stale_share(snapshot({nothing_, {}, {}}, farther, with)), 1);
}

}  // namespace
}  // namespace liloc
