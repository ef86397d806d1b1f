#include "client/odometry/odometry.hpp"

#include <gtest/gtest.h>

#include "common/geometry/depth.hpp"
#include "common/testing/walk.hpp"

namespace liloc {
namespace {

using namespace test;

OdometryOptions small_options() {
  OdometryOptions options;
  options.camera = scene::small_camera();
  return options;
}

OdometryStep step_at(Odometry& odometry, const scene::BoxRoom& room, const Pose& T, StampNs stamp_ns) {
  const DepthImage image = scene::render(room, T, scene::small_camera(), stamp_ns, 0.003);
  const auto cloud = depth_to_cloud(image, scene::small_camera());
  return odometry.step(image, extract_surfels(*cloud, Eigen::Vector3f::Zero()), true, nullptr);
}

/// Along a bare wall at 0.3 m/s until the odometry says that it may be wrong; its last step.
OdometryStep walked_into_doubt(Odometry& odometry) {
  OdometryStep step;
  for (int i = 0; i < 60 && !step.doubtful; ++i)
    step =
        step_at(odometry, scene::corridor(), scene::looking({0.02 * i, 1, 1.2}, 1.5707963, 0.4), stamp_of(i));
  return step;
}

TEST(Odometry, ANewSegmentDoesNotInheritTheDoubtOfTheLast) {
  Odometry odometry(small_options());
  const OdometryStep before = walked_into_doubt(odometry);
  ASSERT_TRUE(before.doubtful);
  EXPECT_GT(before.sd_m, 0.15);
  odometry.clock_set();
  OdometryStep after;
  for (int i = 0; i < 3; ++i) after = step_at(odometry, scene::furnished_room(1), walk(0), stamp_of(i));
  EXPECT_EQ(after.segment, before.segment + 1);
  EXPECT_TRUE(after.converged);
  EXPECT_LT(after.sd_m, 0.02);
  EXPECT_LT(after.sd_rad, 0.02);
}

}  // namespace
}  // namespace liloc
