#include "common/registration/sight/panorama.hpp"

#include <gtest/gtest.h>

#include "common/geometry/depth.hpp"
#include "common/geometry/voxel.hpp"
#include "common/testing/box_room.hpp"

namespace liloc {
namespace {

/// What a camera that turns at one place of a seeded room sees, in the first view's axes.
Cloud seen_around(unsigned seed, const Eigen::Vector3d& at) {
  const scene::BoxRoom room = scene::furnished_room(seed);
  const Camera camera = scene::small_camera();
  const Pose T_map_first = scene::looking(at, 0);
  Cloud cloud;
  for (int i = 0; i < 6; ++i) {
    const Pose T = scene::looking(at, i * M_PI / 3, radians(10));
    append(cloud, transformed(T_map_first.inverse() * T,
                              *depth_to_cloud(scene::render(room, T, camera, 1, 0.004, seed), camera)));
  }
  return voxel_downsample(cloud, 0.05);
}

class PanoramaLaw : public testing::TestWithParam<unsigned> {};

TEST_P(PanoramaLaw, RightPosesLeaveFreeSpaceFreeAndWrongOnesDoNot) {
  const Eigen::Vector3d a(2.4, 2.2, 1.3), b(3.4, 2.6, 1.2);
  const Cloud here = seen_around(GetParam(), a), there = seen_around(GetParam(), b);
  const Panorama panorama(here.points);
  EXPECT_TRUE(panorama.seen_from_origin());
  const Pose T_here_there = scene::looking(a, 0).inverse() * scene::looking(b, 0);
  const auto share = [&](const Pose& T) {
    const Panorama::Count count = panorama.count(there.points, T, 0.15);
    EXPECT_GT(count.known, static_cast<int>(there.size() / 3));
    return count.conflict / static_cast<double>(count.known);
  };
  EXPECT_LT(share(T_here_there), 0.02);
  for (const double shift_m : {-1.0, 1.0}) {
    Pose T = T_here_there;
    T.translation().x() += shift_m;
    EXPECT_GT(share(T), 0.05) << shift_m;
  }
}

TEST_P(PanoramaLaw, AToleranceIsKept) {
  const Cloud here = seen_around(GetParam(), {2.4, 2.2, 1.3});
  const Panorama panorama(here.points);
  Pose nearer = Pose::Identity();
  nearer.linear() *= 0.8;  // towards the origin, by 0.2 m and more where the range is over 1 m
  const auto conflicts = [&](double tolerance_m) {
    return panorama.count(here.points, nearer, tolerance_m).conflict;
  };
  EXPECT_EQ(panorama.count(here.points, Pose::Identity(), 0.0).conflict, 0);
  EXPECT_GT(conflicts(0.1), conflicts(0.4));
  EXPECT_GT(conflicts(0.4), 0);
  EXPECT_EQ(conflicts(9.0), 0);
}

TEST_P(PanoramaLaw, ACloudThatWasSeenFromElsewhereSaysSo) {
  const Cloud here = seen_around(GetParam(), {2.4, 2.2, 1.3});
  Pose outside = Pose::Identity();
  outside.translation() = Eigen::Vector3d(0, 0.5, 9);
  EXPECT_FALSE(Panorama(transformed(outside, here).points).seen_from_origin());
  EXPECT_FALSE(Panorama({}).seen_from_origin());
}

INSTANTIATE_TEST_SUITE_P(Seeds, PanoramaLaw, testing::Range(1U, 6U));

}  // namespace
}  // namespace liloc
