#include "client/odometry/points_view.hpp"

#include <gtest/gtest.h>

#include "common/geometry/depth.hpp"
#include "common/testing/walk.hpp"

namespace liloc {
namespace {

using namespace test;

TEST(PointsView, TheImageOfACloudIsTheImageItCameFrom) {
  const auto room = scene::furnished_room(3);
  const DepthImage image = frame_at(room, 10, 0);
  const auto cloud = depth_to_cloud(image, scene::small_camera(), {.max_range_m = 60, .flying_pixel_share = 0});
  ASSERT_TRUE(cloud);
  const DepthImage back = depth_of_points(*cloud, scene::small_camera(), image.stamp_ns);
  int off = 0;
  for (std::size_t i = 0; i < image.units.size(); ++i)
    if (image.units[i] >= 250) off += back.units[i] != image.units[i];
  EXPECT_EQ(off, 0);
}

TEST(PointsView, TheNearestPointOfAPixelWinsAndHolesOfOnePixelClose) {
  const Camera camera{4, 1, 1, 1, 1.5, 0, 0.001};
  const auto pixel = [&](int u, float z) { return Eigen::Vector3f(static_cast<float>(u - 1.5) * z, 0, z); };
  const Cloud cloud{{pixel(0, 2), pixel(0, 1), pixel(2, 1.02F), {0, 0, -1}, {NAN, 0, 1}}, {}};
  const DepthImage image = depth_of_points(cloud, camera, 1);
  EXPECT_EQ(image.units[0], 1000);
  EXPECT_NEAR(image.units[1], 1010, 1);  // between two of one surface
  EXPECT_EQ(image.units[3], 0);
}

TEST(PointsView, WhatLiesOutsideTheViewIsLeftOut) {
  const Camera camera = scene::small_camera();
  const Cloud cloud{{{0, 0, 2}, {0, 0, 0.1F}, {0, 0, 20}, {9, 0, 2}, {0, 0, -2}}, {}};
  EXPECT_EQ(within_view(cloud, camera, 0.25, 8.5).size(), 1U);
}

}  // namespace
}  // namespace liloc
