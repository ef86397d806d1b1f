// Whom the ceiling sees move, and what has just left.
#include <gtest/gtest.h>

#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

class DynamicRegionsLaw : public testing::TestWithParam<unsigned> {};

/// Somebody as a box, 1.2 m before the device.
scene::Box person_before(const WatchedRoom& w) {
  Eigen::Vector3d ahead = w.T_map_device.linear().col(2);
  ahead.z() = 0;
  const Eigen::Vector3d at = w.T_map_device.translation() + 1.2 * ahead.normalized();
  return {{at.x() - 0.2, at.y() - 0.2, 0.0}, {at.x() + 0.2, at.y() + 0.2, 1.7}};
}

/// What the ceiling sees of somebody who was not there before.
Cloud seen_moving(const scene::BoxRoom& before, const scene::BoxRoom& now) {
  const Camera camera = scene::small_camera();
  Cloud moving_map;
  for (const Pose& T_map_sensor : ceiling_poses()) {
    const DepthImage still = scene::render(before, T_map_sensor, camera, 1);
    DepthImage image = scene::render(now, T_map_sensor, camera, 1);
    for (std::size_t i = 0; i < image.units.size(); ++i)
      if (image.units[i] == still.units[i]) image.units[i] = 0;
    if (const auto cloud = depth_to_cloud(image, camera)) append(moving_map, transformed(T_map_sensor, *cloud));
  }
  return voxel_downsample(moving_map, 0.15);
}

TEST_P(DynamicRegionsLaw, WhomTheCeilingSeesMoveTheDeviceMaySeeToo) {
  const WatchedRoom w = watched_room(GetParam());
  scene::BoxRoom now = w.room;
  now.furniture.push_back(person_before(w));
  const Query query = look(now, w.T_map_device, GetParam());
  Target target = w.target;
  const Judgement unaware = judge(target, query, query.medium, w.T_map_device, 0.05);
  ASSERT_GT(unaware.conflict, 0.02);
  target.dynamic =
      std::make_shared<const DynamicRegions>(target.surfaces, target.views, seen_moving(w.room, now));
  const Judgement aware = judge(target, query, query.medium, w.T_map_device, 0.05);
  EXPECT_LT(aware.conflict, 0.2 * unaware.conflict);
  EXPECT_EQ(aware.agree, unaware.agree) << "nobody is a surface of the room";
  EXPECT_LE(aware.map_conflict, unaware.map_conflict);
}

TEST_P(DynamicRegionsLaw, WhatTheCeilingLooksThroughByNowIsStale) {
  const WatchedRoom w = watched_room(GetParam());
  scene::BoxRoom before = w.room;
  const scene::Box gone = person_before(w);
  before.furniture.push_back(gone);
  const Target was = watch(before, GetParam());
  const DynamicRegions regions(was.surfaces, w.target.views, {});
  int left = 0, stale = 0, elsewhere = 0;
  for (std::size_t i = 0; i < was->coarse.size(); ++i) {
    const Eigen::Vector3d p = was->coarse.points[i].cast<double>();
    const bool of_it = ((p - gone.low).array() > -0.08).all() && ((gone.high - p).array() > -0.08).all();
    if (of_it && p.z() > 0.2) ++left, stale += regions.stale[i];
    if (!of_it) elsewhere += regions.stale[i];
  }
  ASSERT_GT(left, 20);
  EXPECT_GT(stale, 0.7 * left);
  EXPECT_LT(elsewhere, 0.02 * static_cast<double>(was->coarse.size()));
}

INSTANTIATE_TEST_SUITE_P(Seeds, DynamicRegionsLaw, testing::Range(1U, 7U));

}  // namespace
}  // namespace liloc
