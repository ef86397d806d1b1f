#include "common/geometry/depth.hpp"

#include <gmock/gmock.h>

#include <algorithm>

namespace liloc {
namespace {

const Camera kCamera{64, 48, 50.0, 52.0, 31.5, 23.5, 0.001};

/// The plane n . p = d seen by kCamera, without noise.
DepthImage plane_image(const Eigen::Vector3d& normal, double d) {
  DepthImage image{0, kCamera.width, kCamera.height, {}};
  for (int v = 0; v < image.height; ++v)
    for (int u = 0; u < image.width; ++u) {
      const Eigen::Vector3d ray((u - kCamera.cx) / kCamera.fx, (v - kCamera.cy) / kCamera.fy, 1.0);
      image.units.push_back(
          static_cast<std::uint16_t>(std::lround(d / normal.dot(ray) / kCamera.depth_scale_m)));
    }
  return image;
}

TEST(Depth, PointsLieOnThePlaneThatWasSeen) {
  const Eigen::Vector3d normal = Eigen::Vector3d(0.2, -0.3, 1.0).normalized();
  const auto cloud = depth_to_cloud(plane_image(normal, 2.0), kCamera);
  ASSERT_TRUE(cloud);
  EXPECT_EQ(cloud->size(), 64U * 48U);
  for (const auto& p : cloud->points) EXPECT_NEAR(normal.dot(p.cast<double>()), 2.0, 1e-3);
}

TEST(Depth, TheImageOfACloudIsTheImageItCameFrom) {
  const DepthImage image = plane_image(Eigen::Vector3d(0.2, -0.3, 1.0).normalized(), 2.0);
  const DepthImage back = cloud_to_depth(*depth_to_cloud(image, kCamera), kCamera, 7);
  EXPECT_EQ(back.units, image.units);
  EXPECT_EQ(back.stamp_ns, 7);
}

TEST(Depth, TheNearestPointOfAPixelIsSeenAndWhatNoPixelHoldsIsNot) {
  const Cloud cloud{
      {{0, 0, 2}, {0, 0, 1.5F}, {0, 0, 1.7F}, {0, 0, -1}, {3, 0, 1}, {0, 0, 70}, {NAN, 0, 1}, {0, 0, 0}}, {}};
  const DepthImage image = cloud_to_depth(cloud, kCamera, 1);
  EXPECT_EQ(image.at(32, 24), 1500);
  EXPECT_EQ(std::ranges::count(image.units, 0), 64 * 48 - 1);
}

TEST(Depth, RangeLimitsAndNoReturnAreDropped) {
  DepthImage image = plane_image({0, 0, 1}, 2.0);
  image.units[0] = 0;
  image.units[1] = 100;
  image.units[2] = 60000;
  EXPECT_EQ(depth_to_cloud(image, kCamera, {0.25, 8.5, 0.0})->size(), 64U * 48U - 3U);
}

TEST(Depth, TheLargestValueIsNoReturnWhateverTheScale) {
  Camera fine = kCamera;
  fine.depth_scale_m = 0.0001;  // 65535 would be a wall at 6.55 m
  DepthImage image = plane_image({0, 0, 1}, 2.0);
  std::ranges::fill(image.units, std::uint16_t{20'000});
  std::fill_n(image.units.begin(), 64 * 24, std::uint16_t{65535});
  EXPECT_EQ(depth_to_cloud(image, fine)->size(), 64U * 24U);
  mark_missing(image);
  EXPECT_EQ(std::ranges::count(image.units, 0), 64 * 24);
  EXPECT_EQ(std::ranges::count(image.units, 20'000), 64 * 24);
}

TEST(Depth, APixelThatHangsInTheAirIsDropped) {
  DepthImage image = plane_image({0, 0, 1}, 2.0);
  image.units[64 * 20 + 30] = 1500;
  EXPECT_EQ(depth_to_cloud(image, kCamera)->size(), 64U * 48U - 1U);
}

TEST(Depth, AnImageOfAnotherSizeIsRefused) {
  DepthImage image = plane_image({0, 0, 1}, 2.0);
  image.width = 63;
  EXPECT_THAT(depth_to_cloud(image, kCamera).error().message, testing::HasSubstr("63x48"));
  image.width = 64;
  image.units.pop_back();
  EXPECT_FALSE(depth_to_cloud(image, kCamera));
}

}  // namespace
}  // namespace liloc
