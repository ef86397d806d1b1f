#include "proto-tests/soak/growth.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>

#include "proto-tests/sim/base/random.hpp"

namespace liloc::soak {
namespace {

using testing::DoubleNear;

std::vector<Sample> samples(double seconds, const std::function<double(double)>& value_at) {
  std::vector<Sample> made;
  for (double at_s = 0; at_s < seconds; ++at_s) made.push_back({at_s, value_at(at_s)});
  return made;
}

TEST(SoakGrowth, ASlowLeakShowsInNoise) {
  sim::Random random(1, 1);
  const Trend trend =
      trend_of(samples(600, [&](double s) { return 200 + s * 30 / 3600 + random.normal(); }), 120);
  EXPECT_NEAR(trend.slope_per_h, 30, 5);
  EXPECT_NEAR(trend.growth(), 30.0 / 3600 * 320, 0.5)
      << "a third of 480 s lies between the two thirds' middles";
}

TEST(SoakGrowth, WhatComesAndGoesIsNoGrowth) {
  sim::Random random(2, 1);
  const Trend trend = trend_of(samples(600,
                                       [&](double s) {
                                         const bool peak = static_cast<int>(s) % 50 == 49;
                                         return peak ? 400.0 : 200 + random.normal();
                                       }),
                               120);
  EXPECT_THAT(trend.growth(), DoubleNear(0, 0.5));
  EXPECT_THAT(trend.slope_per_h, DoubleNear(0, 3));
}

// As a server's memory that comes and goes by 300 MB with the rooms that sessions look back at.
TEST(SoakGrowth, WhatBreathesHidesNoLeak) {
  const auto breath = [](double s) { return 300 + 150 * std::sin(s / 3); };
  EXPECT_THAT(trend_of(samples(600, breath), 120).growth(), DoubleNear(0, 3));
  EXPECT_THAT(trend_of(samples(600, [&](double s) { return breath(s) + 0.1 * s; }), 120).growth(),
              DoubleNear(32, 5));
}

TEST(SoakGrowth, AThirdIsAsLongAsItsSamplesReach) {
  EXPECT_NEAR(trend_of(samples(600, [](double) { return 1; }), 120).third_s, 160, 1);
  EXPECT_NEAR(trend_of(samples(100, [](double) { return 1; }), 25).third_s, 25, 1);
  EXPECT_EQ(trend_of({{0, 1}, {1, 2}}, 0).third_s, 0);
}

TEST(SoakGrowth, TheWarmUpCountsNot) {
  const Trend trend = trend_of(samples(600, [](double s) { return s < 100 ? s : 100; }), 120);
  EXPECT_EQ(trend.first, 100);
  EXPECT_EQ(trend.last, 100);
  EXPECT_EQ(trend.slope_per_h, 0);
}

TEST(SoakGrowth, TooFewSamplesTellNothing) {
  EXPECT_EQ(trend_of({}, 0).growth(), 0);
  EXPECT_EQ(trend_of({{0, 1}, {1, 2}}, 0).growth(), 0);
  EXPECT_EQ(trend_of({{0, 1}, {1, 2}, {2, 3}}, 5).growth(), 0);
}

}  // namespace
}  // namespace liloc::soak
