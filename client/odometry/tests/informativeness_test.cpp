#include "client/odometry/informativeness.hpp"

#include <gtest/gtest.h>

#include <random>

#include "common/testing/box_room.hpp"

namespace liloc {
namespace {

/// Depths spread evenly over mean +- spread.
DepthImage spread_image(double mean_m, double half_m, unsigned seed, double valid = 1.0) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> depth(mean_m - half_m, mean_m + half_m), unit(0, 1);
  DepthImage image;
  image.width = 160;
  image.height = 120;
  for (int i = 0; i < 160 * 120; ++i)
    image.units.push_back(unit(rng) < valid ? static_cast<std::uint16_t>(1000 * depth(rng)) : 0);
  return image;
}

class Sudden : public testing::Test {
 protected:
  FrameFault judge(double half_m, double valid = 1.0, double mean_m = 3.0) {
    return judge_.judge(spread_image(mean_m, half_m, ++seed_, valid), scene::small_camera(), 0.25, 8.5).fault;
  }
  void see_usual_frames() {
    for (int i = 0; i < 10; ++i) ASSERT_EQ(judge(1.0), FrameFault::none);
  }
  Informativeness judge_;
  unsigned seed_ = 0;
};

TEST_F(Sudden, TheSpreadIsTheStandardDeviation) {
  const auto spread = judge_.judge(spread_image(3, 1.2, 7), scene::small_camera(), 0.25, 8.5);
  EXPECT_NEAR(spread.sd_m, 1.2 / std::sqrt(3.0), 0.03);
  EXPECT_NEAR(spread.valid_share, 1.0, 1e-9);
}

TEST_F(Sudden, ASpikeAndADropAreSeenAndPass) {
  see_usual_frames();
  EXPECT_EQ(judge(1.8), FrameFault::spike);
  EXPECT_EQ(judge(1.0), FrameFault::none);
  EXPECT_EQ(judge(0.4), FrameFault::drop);
  EXPECT_EQ(judge(1.0), FrameFault::none);
}

TEST_F(Sudden, ASlowChangePasses) {
  see_usual_frames();
  for (double half = 1.0; half < 2.5; half *= 1.06) EXPECT_EQ(judge(half), FrameFault::none) << half;
  for (double half = 2.4; half > 0.5; half *= 0.94) EXPECT_EQ(judge(half), FrameFault::none) << half;
}

TEST_F(Sudden, ANewLevelIsAcceptedAfterAWhile) {
  see_usual_frames();
  int refused = 0;
  while (judge(2.0) != FrameFault::none) ++refused;
  EXPECT_GE(refused, 2);
  EXPECT_LE(refused, 5);
  EXPECT_EQ(judge(1.9), FrameFault::none);
}

TEST_F(Sudden, ACoveredCameraIsSeenAtOnceAndForAsLongAsItLasts) {
  see_usual_frames();
  for (int i = 0; i < 30; ++i) EXPECT_EQ(judge(0.1, 0.9, 0.4), FrameFault::covered);
  EXPECT_EQ(judge(1.5), FrameFault::none);  // what comes after is a new scene, not a spike
}

TEST_F(Sudden, TooFewPointsAndABareWall) {
  EXPECT_EQ(judge(1.0, 0.03), FrameFault::too_few_points);
  EXPECT_EQ(judge(0.02), FrameFault::flat);
  EXPECT_EQ(judge_.judge(spread_image(3, 1, 1, 0.0), scene::small_camera(), 0.25, 8.5).fault,
            FrameFault::too_few_points);
}

TEST(Informativeness, AWalkThroughARoomIsInformative) {
  const auto room = scene::furnished_room(4);
  Informativeness judge;
  for (int i = 0; i < 90; ++i) {
    const Pose T = scene::looking({2.0 + 0.02 * i, 2.5, 1.2}, 0.05 * i, 0.1);
    const auto spread = judge.judge(scene::render(room, T, scene::small_camera(), i + 1, 0.005),
                                    scene::small_camera(), 0.25, 8.5);
    EXPECT_TRUE(spread.informative()) << i << ": " << name_of(spread.fault) << ' ' << spread.sd_m;
  }
}

}  // namespace
}  // namespace liloc
