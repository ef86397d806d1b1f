#include "server/survey/lidar_scan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/survey/tests/ceiling.hpp"

namespace liloc::survey {
namespace {

using namespace test;
using testing::HasSubstr;

TEST(LidarScan, ItsNormalsFaceTheSensor) {
  for (const LidarScan& scan : scans(2))
    for (std::size_t i = 0; i < scan.cloud.size(); ++i)
      ASSERT_LE(scan.cloud.normals[i].dot(scan.cloud.points[i]), 0);
}

TEST(LidarScan, ABlockedViewAndAnotherSizeAreNamed) {
  const GlobalLidar lidar{"ceiling7", scene::small_camera(), 6, Pose::Identity()};
  DepthImage blocked{1, lidar.camera.width, lidar.camera.height, {}};
  blocked.units.assign(160 * 120, 0);
  EXPECT_THAT(make_scan(lidar, blocked, kVoxel_m).error().message,
              testing::AllOf(HasSubstr("ceiling7"), HasSubstr("is its view blocked")));
  EXPECT_THAT(
      make_scan(lidar, DepthImage{1, 8, 8, std::vector<std::uint16_t>(64, 1000)}, kVoxel_m).error().message,
      HasSubstr("ceiling7"));
}

TEST(LidarScan, CorrectedDepthsAreScaledAndShiftedAlongTheRay) {
  const Cloud cloud{{{0.5F, -0.25F, 2}, {0, 1, 4}}, {}};
  const Cloud right = corrected(cloud, {.scale = 0.01, .bias_m = 0.02});
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f &was = cloud.points[i], &is = right.points[i];
    EXPECT_NEAR(is.z(), 1.01F * was.z() + 0.02F, 1e-5F);
    EXPECT_LT(is.normalized().cross(was.normalized()).norm(), 1e-6F) << "pixels stay where they are";
  }
  EXPECT_EQ(corrected(cloud, {}).points, cloud.points);
}

}  // namespace
}  // namespace liloc::survey
