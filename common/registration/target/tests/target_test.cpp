#include "common/registration/target/target.hpp"

#include <gtest/gtest.h>

#include "common/testing/changed_room.hpp"
#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

class SurfacesLaw : public testing::TestWithParam<unsigned> {};

void expect_same(const NearestGrid& a, const NearestGrid& b, const Eigen::AlignedBox3f& box, float step) {
  std::size_t found = 0, different = 0;
  for (float z = box.min().z(); z < box.max().z(); z += step)
    for (float y = box.min().y(); y < box.max().y(); y += step)
      for (float x = box.min().x(); x < box.max().x(); x += step) {
        found += a.nearest({x, y, z}) != NearestGrid::kNone;
        different += a.nearest({x, y, z}) != b.nearest({x, y, z});
      }
  EXPECT_EQ(different, 0U);
  EXPECT_GT(found, 1000U);
}

void expect_same(const ScoreField& a, const ScoreField& b) {
  ASSERT_EQ(a.size(), b.size());
  ASSERT_EQ(a.origin(), b.origin());
  std::size_t different = 0, free = 0, surfaces = 0;
  for (int plane = 0; plane <= ScoreField::kAny; ++plane)
    for (int z = 0; z < a.size().z(); ++z)
      for (int y = 0; y < a.size().y(); ++y)
        for (int x = 0; x < a.size().x(); ++x) {
          different += a.row(y, z, plane)[x] != b.row(y, z, plane)[x];
          free += a.row(y, z, plane)[x] < 0;
          surfaces += a.row(y, z, plane)[x] > 0;
        }
  EXPECT_EQ(different, 0U);
  EXPECT_GT(free, 1000U);
  EXPECT_GT(surfaces, 1000U);
}

TEST_P(SurfacesLaw, IndicesOfARoomThatChangedAreThoseOfARoomBuiltAnew) {
  const WatchedRoom w = watched_room(GetParam());
  const std::vector<SightView> others = watch(w.room, GetParam() + 100).views;  // the same sensors, other noise
  std::mt19937_64 rng(GetParam());
  auto before = std::make_shared<const Surfaces>(w.target->cloud, w.target.views, 0.05);
  (void)before->field_fine();
  Cloud cloud = w.target->cloud;
  for (int round = 0; round < 5; ++round) {
    cloud = changed(cloud, rng);
    std::vector<SightView> views = w.target.views;
    for (SightView& view : views)
      if (rng() % 2 == 0) view = others[static_cast<std::size_t>(&view - views.data())];
    if (round == 3) views.pop_back();  // a sensor falls silent
    const auto now = std::make_shared<const Surfaces>(cloud, views, 0.05, before.get());
    const Surfaces anew(cloud, views, 0.05);
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& p : cloud.points) box.extend(p);
    box.min().array() -= 0.5F;
    box.max().array() += 0.5F;
    expect_same(now->nearest, anew.nearest, box, 0.04F);
    expect_same(now->nearest_coarse, anew.nearest_coarse, box, 0.07F);
    expect_same(now->field_coarse().regions().front(), anew.field_coarse().regions().front());
    expect_same(now->field_fine().regions().front(), anew.field_fine().regions().front());
    before = now;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, SurfacesLaw, testing::Range(1U, 5U));

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

TEST_P(DynamicRegionsLaw, WhatTheCeilingFindsNoMoreIsStaleThoughNobodyLooksThroughIt) {
  const WatchedRoom w = watched_room(GetParam());
  const Eigen::Vector3f& gone = w.target->coarse.points[GetParam() * 37 % w.target->coarse.size()];
  const DynamicRegions before(w.target.surfaces, w.target.views, {}),
      regions(w.target.surfaces, w.target.views, {}, {{gone}, {}});
  EXPECT_TRUE(regions.mask.empty()) << "nobody moves there";
  for (std::size_t i = 0; i < w.target->coarse.size(); ++i) {
    const float away_m = (w.target->coarse.points[i] - gone).norm();
    if (away_m < 0.1F) {
      EXPECT_TRUE(regions.stale[i]);
    } else if (away_m > 0.4F) {
      EXPECT_EQ(regions.stale[i], before.stale[i]);
    }
  }
}

TEST_P(DynamicRegionsLaw, WhoeverMovesMakesEmptySpaceUnknownAndLeavesSurfaces) {
  const WatchedRoom w = watched_room(GetParam());
  const ScoreField& field = w.target->field_coarse().regions().front();
  Eigen::Vector3f empty = Eigen::Vector3f::Zero();
  std::mt19937_64 rng(GetParam());
  std::uniform_real_distribution<float> x(1, 5), y(1, 4), z(0.6F, 2);
  do empty = {x(rng), y(rng), z(rng)};
  while (field.at(empty, ScoreField::kUp) >= 0);
  const DynamicRegions regions(w.target.surfaces, w.target.views, {{empty}, {}});
  EXPECT_TRUE(regions.mask.at(empty));
  EXPECT_FALSE(regions.mask.at(empty + Eigen::Vector3f(1.5F, 0, 0)));
  const ScoreField& masked = regions.field_coarse().regions().front();
  EXPECT_EQ(masked.at(empty, ScoreField::kUp), 0);
  for (const Eigen::Vector3f& p : w.target->coarse.points)
    ASSERT_EQ(masked.at(p, ScoreField::kAny), field.at(p, ScoreField::kAny));
  EXPECT_EQ(&DynamicRegions(w.target.surfaces, w.target.views, {}).field_coarse().regions().front(), &field);
}

INSTANTIATE_TEST_SUITE_P(Seeds, DynamicRegionsLaw, testing::Range(1U, 7U));

}  // namespace
}  // namespace liloc
