#include "server/plan/outline.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "server/plan/free_floor.hpp"

namespace liloc::plan {
namespace {

using Eigen::Vector2d;
using testing::HasSubstr;

Outline square(double side_m, double gap_m) {
  Outline outline = blank_outline({0, 0}, {side_m, side_m}).value();
  draw_wall(outline, {0, 0}, {side_m, 0});
  draw_wall(outline, {side_m, 0}, {side_m, side_m});
  draw_wall(outline, {side_m, side_m}, {0, side_m});
  draw_wall(outline, {0, side_m}, {0, gap_m});
  return outline;
}

TEST(Outline, BecomesARoomOfItsHeight) {
  const Cloud cloud = extruded(square(5, 0), 3).value();
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : cloud.points) box.extend(p);
  EXPECT_LT(box.min().cwiseAbs().maxCoeff(), 0.11F) << box.min().transpose();
  EXPECT_LT((box.max() - Eigen::Vector3f(5, 5, 3)).cwiseAbs().maxCoeff(), 0.11F) << box.max().transpose();
  const VoxelRoom room = VoxelRoom::create(cloud).value();
  const FreeFloor floor = find_free_floor(room).value();
  EXPECT_NEAR(*floor.ceiling_z_m, 3, 0.1);
  EXPECT_NEAR(floor.area_m2, 4.3 * 4.3, 2);
}

TEST(Outline, WallsHaveNoGapForRays) {
  Outline outline = blank_outline({0, 0}, {8, 8}).value();
  const Vector2d corners[] = {{4, 0.2}, {7.8, 3.3}, {4.4, 7.7}, {0.3, 4.1}};
  for (int i = 0; i < 4; ++i) draw_wall(outline, corners[i], corners[(i + 1) % 4]);
  const VoxelRoom room = VoxelRoom::create(extruded(outline, 3).value()).value();
  for (int i = 0; i < 720; ++i) {
    const double angle = radians(0.5 * i);
    EXPECT_TRUE(
        room.first_hit({4, 4, 1.5F}, Eigen::Vector3d(std::cos(angle), std::sin(angle), 0).cast<float>(), 8));
  }
}

TEST(Outline, AGapInTheOuterWallIsNamed) {
  EXPECT_THAT(extruded(square(5, 0.5), 3).error().message, HasSubstr("close the gaps"));
  EXPECT_THAT(extruded(blank_outline({0, 0}, {5, 5}).value(), 3).error().message, HasSubstr("close the gaps"));
}

// Stripes of wall and of floor: a hundred thousand cells of wall, 601 points each.
TEST(Outline, MoreWallsThanMemoryHoldsAreRefused) {
  Outline outline = blank_outline({0, 0}, {20, 20}).value();
  for (int y = 0; y < outline.height; ++y)
    for (int x = 0; x < outline.width; ++x)
      if (x % 3 != 0 || y < 9 || y > outline.height - 9) outline.at(x, y) = 1;
  const auto cloud = extruded(outline, 30);
  ASSERT_FALSE(cloud);
  EXPECT_THAT(cloud.error().message, HasSubstr("million points"));
  EXPECT_THAT(cloud.error().message, HasSubstr("hatches"));
}

TEST(Outline, AnotherUnitIsNamed) {
  EXPECT_THAT(blank_outline({0, 0}, {5000, 4000}).error().message, HasSubstr("--scale"));
  EXPECT_THAT(blank_outline({0, 0}, {0.5, 0.4}).error().message, HasSubstr("--scale"));
  EXPECT_FALSE(blank_outline({0, 0}, {std::nan(""), 4}));
}

TEST(Outline, WhatLiesOutsideIsLeftOut) {
  Outline outline = blank_outline({0, 0}, {5, 5}).value();
  draw_wall(outline, {-1e9, 2}, {1e9, 2});
  draw_wall(outline, {std::nan(""), 2}, {3, 3});
  EXPECT_LE(std::ranges::count(outline.wall, 1), 2 * outline.width);
}

}  // namespace
}  // namespace liloc::plan
