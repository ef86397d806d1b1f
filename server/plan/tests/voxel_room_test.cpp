#include "server/plan/voxel_room.hpp"

#include <gmock/gmock.h>

#include <random>

#include "server/plan/tests/scanned_room.hpp"

namespace liloc::plan {
namespace {

using testing::HasSubstr;

VoxelRoom room() {
  return VoxelRoom::create(test::scan_of_two_rooms()).value();
}

/// The same by steps of a hundredth of a voxel.
std::optional<Eigen::Vector3f> slowly(const VoxelRoom& room, const Eigen::Vector3f& from,
                                      const Eigen::Vector3f& direction, float range_m) {
  for (float t = 0.2F; t < range_m; t += 0.001F)
    if (room.occupied(from + t * direction)) return from + t * direction;
  return std::nullopt;
}

class RayLaw : public testing::TestWithParam<unsigned> {};

TEST_P(RayLaw, MeetsWhatASlowWalkMeets) {
  const VoxelRoom r = room();
  std::mt19937 rng(GetParam());
  std::uniform_real_distribution<float> unit(0, 1);
  for (int i = 0; i < 100; ++i) {
    const Eigen::Vector3f from(0.3F + 3.8F * unit(rng), 0.3F + 1.5F * unit(rng), 0.3F + 2.4F * unit(rng));
    const Eigen::Vector3f direction =
        (Eigen::Vector3f(unit(rng), unit(rng), unit(rng)).array() - 0.5F).matrix().normalized();
    const auto hit = r.first_hit(from, direction, 6);
    const auto expected = slowly(r, from, direction, 6);
    ASSERT_EQ(hit.has_value(), expected.has_value()) << i;
    if (!hit) continue;
    EXPECT_NEAR(hit->distance_m, (*expected - from).norm(), 0.05) << i;  // a corner may be grazed
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, RayLaw, testing::Range(1U, 5U));

TEST(VoxelRoom, TwoSidesOfAWallAreTwoSurfaces) {
  const VoxelRoom r = room();
  const auto left = r.first_hit({3, 4, 1.5F}, {1, 0, 0}, 6), right = r.first_hit({6, 4, 1.5F}, {-1, 0, 0}, 6);
  ASSERT_TRUE(left && right);
  EXPECT_NE(left->surface, right->surface);
  EXPECT_LT(r.normal_map(left->surface).x(), -0.9);
  EXPECT_GT(r.normal_map(right->surface).x(), 0.9);
}

TEST(VoxelRoom, NothingIsSeenBehindAWall) {
  const auto hit = room().first_hit({3, 4, 1.5F}, {1, 0, 0}, 8);
  ASSERT_TRUE(hit);
  EXPECT_NEAR(hit->distance_m, 1.4, kVoxel_m);
}

TEST(VoxelRoom, ARayEndsAtItsRangeAndOutsideTheRoom) {
  EXPECT_FALSE(room().first_hit({3, 4, 1.5F}, {1, 0, 0}, 1));
  EXPECT_FALSE(room().first_hit({-100, 4, 1.5F}, {1, 0, 0}, 200));
  EXPECT_FALSE(room().occupied({1e9F, 0, 0}));
}

TEST(VoxelRoom, StrayPointsNeitherWidenNorBlockIt) {
  Cloud scan = test::scan_of_two_rooms();
  const VoxelRoom clean = room();
  scan.points.emplace_back(5000, 0, 0);
  scan.points.emplace_back(2.05F, 4.05F, 1.5F);
  scan.points.emplace_back(std::nanf(""), 0, 0);
  const VoxelRoom r = VoxelRoom::create(scan).value();
  EXPECT_EQ(r.voxels(), clean.voxels());
  EXPECT_FALSE(r.occupied({2.05F, 4.05F, 1.5F}));
}

TEST(VoxelRoom, WhatCannotBeARoomIsNamed) {
  Cloud scan = test::scan_of_two_rooms(), millimetres = scan, few;
  for (Eigen::Vector3f& p : millimetres.points) p *= 1000;
  EXPECT_THAT(VoxelRoom::create(millimetres).error().message, HasSubstr("in metres?"));
  EXPECT_THAT(VoxelRoom::create({}).error().message, HasSubstr("in metres?"));
  for (std::size_t i = 0; i < scan.size(); i += 400) few.points.push_back(scan.points[i]);
  EXPECT_THAT(VoxelRoom::create(few).error().message, HasSubstr("of at least 500"));
  Cloud vast;
  for (int i = 0; i < 4000; ++i)
    vast.points.emplace_back(0.05F * static_cast<float>(i), 0.05F * static_cast<float>(i),
                             0.05F * static_cast<float>(i));
  EXPECT_THAT(VoxelRoom::create(vast).error().message, HasSubstr("give a part of it"));
}

}  // namespace
}  // namespace liloc::plan
