#include "server/survey/joint_refine.hpp"

#include <gtest/gtest.h>

#include "server/survey/tests/ceiling.hpp"

namespace liloc::survey {
namespace {

using namespace test;

/// The LiDARs of a room, each 4 cm and 1.5 degrees beside where it hangs.
struct Ceiling {
  explicit Ceiling(unsigned seed) : scans(test::scans(seed)) {
    for (std::size_t i = 0; i < scans.size(); ++i) {
      JointLidar lidar;
      lidar.cloud = &scans[i].cloud;
      lidar.T_map_sensor = disturbed(hung()[i], 10 * seed + static_cast<unsigned>(i), 0.04, radians(1.5));
      lidars.push_back(lidar);
    }
  }
  void expect_near_truth(std::size_t i, double within_m = 0.01) const {
    EXPECT_LT(distance_m(lidars[i].T_map_sensor, hung()[i]), within_m) << i;
    EXPECT_LT(angle_between_rad(lidars[i].T_map_sensor, hung()[i]), radians(0.25)) << i;
  }
  std::vector<LidarScan> scans;
  std::vector<JointLidar> lidars;
};

class JointRefineLaw : public testing::TestWithParam<unsigned> {};

TEST_P(JointRefineLaw, WithoutAScanTheOthersComeToTheOneThatIsFixed) {
  Ceiling ceiling(GetParam());
  ceiling.lidars[0].T_map_sensor = hung()[0];
  ceiling.lidars[0].fixed = true;
  refine_together(nullptr, &ceiling.lidars, {});
  EXPECT_LT(distance_m(ceiling.lidars[0].T_map_sensor, hung()[0]), 1e-6) << "it holds the others";
  for (const std::size_t i : {1U, 2U}) {
    ceiling.expect_near_truth(i);
    EXPECT_GT(ceiling.lidars[i].pairs, 100);
    EXPECT_LT(ceiling.lidars[i].residual_m, 0.02);
  }
}

TEST_P(JointRefineLaw, AScanHoldsThemAll) {
  Ceiling ceiling(GetParam());
  Cloud scan_map = rest_of(ceiling.scans, ceiling.scans.size());
  scan_map.normals.clear();
  const auto reference = Reference::create(scan_map, kVoxel_m);
  ASSERT_TRUE(reference) << reference.error().message;
  refine_together(&*reference, &ceiling.lidars, {});
  for (std::size_t i = 0; i < ceiling.lidars.size(); ++i) ceiling.expect_near_truth(i);
}

TEST_P(JointRefineLaw, WhoIsLeftOutNeitherMovesNorPulls) {
  Ceiling ceiling(GetParam());
  ceiling.lidars[0].T_map_sensor = hung()[0];
  ceiling.lidars[0].fixed = true;
  const Pose stays = disturbed(hung()[2], GetParam(), 0.1, radians(4));  // near enough to be paired
  ceiling.lidars[2].T_map_sensor = stays;
  ceiling.lidars[2].left_out = true;
  refine_together(nullptr, &ceiling.lidars, {});
  EXPECT_TRUE(ceiling.lidars[2].T_map_sensor.isApprox(stays, 1e-6));
  EXPECT_EQ(ceiling.lidars[2].pairs, 0);
  ceiling.expect_near_truth(1, 0.02);  // two see less of each other than three
}
INSTANTIATE_TEST_SUITE_P(Seeds, JointRefineLaw, testing::Range(1U, 5U));

}  // namespace
}  // namespace liloc::survey
