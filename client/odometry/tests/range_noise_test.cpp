#include "client/odometry/range_noise.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "common/testing/walk.hpp"

namespace liloc {
namespace {

using namespace test;

class RangeNoiseLaw : public testing::TestWithParam<int> {};

TEST_P(RangeNoiseLaw, LearnsWhatAStandingSensorShows) {
  const double noise_m = 0.001 * GetParam();
  RangeNoise noise(0.001);
  const auto room = scene::furnished_room(1);
  DepthImage before = frame_at(room, 0, noise_m);
  for (int i = 1; i < 15; ++i) {  // the walk stands still for a second
    const DepthImage after = frame_at(room, i, noise_m);
    noise.learn(before, after);
    before = after;
  }
  EXPECT_NEAR(noise.sd_units(2500), std::max(std::sqrt(2.0) * GetParam(), 5.0),
              0.3 * std::sqrt(2.0) * GetParam());
}
INSTANTIATE_TEST_SUITE_P(Millimetres, RangeNoiseLaw, testing::Values(4, 8, 15));

TEST(RangeNoise, IsBoundedWhileTheDeviceMoves) {
  RangeNoise noise(0.001);
  const float at_first = noise.sd_units(3000);
  const auto room = scene::furnished_room(1);
  for (int i = 60; i < 90; ++i) noise.learn(frame_at(room, i), frame_at(room, i + 5));
  EXPECT_LE(noise.sd_units(3000), at_first);
}

TEST(RangeNoise, TheSameFrameTwiceTellsNothing) {
  RangeNoise noise(0.001);
  const float at_first = noise.sd_units(3000);
  const DepthImage frame = frame_at(scene::furnished_room(1), 0);
  for (int i = 0; i < 10; ++i) noise.learn(frame, frame);
  EXPECT_EQ(noise.sd_units(3000), at_first);
}

}  // namespace
}  // namespace liloc
