#include "common/registration/scan/local_map.hpp"

#include <gtest/gtest.h>

#include "common/geometry/depth.hpp"
#include "common/testing/box_room.hpp"

namespace liloc {
namespace {

using scene::BoxRoom;
using scene::furnished_room;
using scene::looking;
using scene::render;
using scene::small_camera;

std::vector<Surfel> surfels_of(const DepthImage& image) {
  return extract_surfels(*depth_to_cloud(image, small_camera()), Eigen::Vector3f::Zero());
}

TEST(LocalMap, FindsWhatWasInsertedOnTheSameSideOnly) {
  const Pose T = looking({3, 2.5, 1.2}, 0.3);
  const auto frame = surfels_of(render(furnished_room(1), T, small_camera(), 1));
  LocalMap map;
  map.insert(T, frame, 1);
  ASSERT_GT(map.size(), 100U);
  int found = 0, behind = 0;
  for (const Surfel& s : frame) {
    const Eigen::Vector3f p = T.cast<float>() * s.mean, n = T.linear().cast<float>() * s.normal;
    found += map.find(p, n) != nullptr;
    behind += map.find(p, -n) != nullptr;
  }
  EXPECT_GT(found, static_cast<int>(0.99 * static_cast<double>(frame.size())));
  EXPECT_LT(behind, found / 50);  // a few where two faces of a thin box share a cell
  EXPECT_EQ(map.find({100, 100, 100}, {0, 0, 1}), nullptr);
}

TEST(LocalMap, MemoryIsBoundedAndTheLongestUnseenGo) {
  LocalMapOptions options;
  options.max_surfels = 500;
  LocalMap map(options);
  Surfel s;
  s.normal = {0, 0, 1};
  s.count = 10;
  for (int i = 0; i < 3000; ++i) {
    s.mean = {0.2F * static_cast<float>(i), 0, 0};
    map.insert(Pose::Identity(), {s}, i + 1);
    ASSERT_LE(map.size(), 500U);
  }
  EXPECT_NE(map.find(s.mean, s.normal), nullptr);
  EXPECT_EQ(map.find({0, 0, 0}, s.normal), nullptr);
}

TEST(LocalMap, FullSurfelsStayWhereTheyWere) {
  LocalMapOptions options;
  options.full_weight = 100;
  LocalMap map(options);
  Surfel s;
  s.mean = {0.05F, 0.05F, 0.05F};
  s.covariance = Eigen::Vector3f(1e-3F, 1e-3F, 1e-6F).asDiagonal();
  s.normal = {0, 0, 1};
  s.count = 60;
  const Pose T_above = Pose(Eigen::Translation3d(0, 0, 1));
  const auto insert_at = [&](float z, StampNs stamp) {
    Surfel seen = s;
    seen.mean.z() = z - 1.0F;  // sensor frame
    map.insert(T_above, {seen}, stamp);
  };
  insert_at(0.05F, 1);
  insert_at(0.06F, 2);
  const float frozen = map.find(s.mean, s.normal)->surfel.mean.z();
  EXPECT_NEAR(frozen, 0.055F, 1e-4F);
  insert_at(0.09F, 3);
  EXPECT_FLOAT_EQ(map.find(s.mean, s.normal)->surfel.mean.z(), frozen);
}

TEST(LocalMap, WhatMovedAwayIsCarved) {
  BoxRoom with = furnished_room(2);
  const BoxRoom without = with;
  with.furniture.push_back({{4.0, 2.3, 0}, {4.4, 2.8, 1.8}});  // somebody stands in view
  const Pose T = looking({2, 2.5, 1.2}, 0);
  LocalMap map;
  map.insert(T, surfels_of(render(with, T, small_camera(), 1)), 1);
  const Eigen::Vector3f front(4.0F, 2.55F, 1.25F), facing(-1, 0, 0);
  ASSERT_NE(map.find(front, facing), nullptr);
  const auto before = map.compare(T, render(without, T, small_camera(), 2), small_camera(), 8.5);
  EXPECT_GT(before.through, 20);
  for (StampNs stamp = 2; stamp < 4; ++stamp)
    map.carve(T, render(without, T, small_camera(), stamp), small_camera(), 8.5);
  EXPECT_EQ(map.find(front, facing), nullptr);
  const auto after = map.compare(T, render(without, T, small_camera(), 4), small_camera(), 8.5);
  EXPECT_LT(after.refuted_share(), 0.02);
}

TEST(LocalMap, YoungSurfelsCountLess) {
  const Pose T = looking({2, 2.5, 1.2}, 0);
  const auto frame = surfels_of(render(furnished_room(3), T, small_camera(), 1));
  LocalMap map;
  for (int i = 0; i < 4; ++i) map.insert(T, frame, from_ms(300.0 * i));
  const auto* cell =
      map.find(T.cast<float>() * frame.front().mean, T.linear().cast<float>() * frame.front().normal);
  ASSERT_NE(cell, nullptr);
  EXPECT_EQ(map.trust(*cell, from_ms(100)), LocalMap::kYoungWeight);
  EXPECT_EQ(map.trust(*cell, from_ms(1000)), 1.0F);
}

}  // namespace
}  // namespace liloc
