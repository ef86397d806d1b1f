// What the background makes of sensors that are noisy by their steps, or seldom have a return.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "server/global_cloud/background.hpp"

namespace liloc {
namespace {

const Camera kCamera{40, 30, 30.0, 30.0, 19.5, 14.5, 0.001};
constexpr StampNs kT0 = 1'700'000'000'000'000'000;
constexpr double kPeriod_s = 1 / 6.0;

class SensorLaw : public testing::TestWithParam<int> {
 protected:
  /// A wall that leans from `near_m` to `far_m`, as structured light tells it, each pixel there with a chance.
  DepthImage frame(int i, double near_m, double far_m, double chance, double noise = 1.65e-3,
                   double step = 2.85e-3) {
    DepthImage image{kT0 + from_seconds(kPeriod_s * i), 40, 30, std::vector<std::uint16_t>(40 * 30, 0)};
    for (int v = 0; v < 30; ++v)
      for (int u = 0; u < 40; ++u) {
        if (share_(rng_) > chance) continue;
        const double inverse = 1 / (near_m + (far_m - near_m) * u / 39) + noise * normal_(rng_);
        const double whole = step > 0 ? step * std::round(inverse / step) : inverse;
        image.units[static_cast<std::size_t>(v * 40 + u)] = static_cast<std::uint16_t>(1000 / whole);
      }
    return image;
  }

  std::mt19937 rng_{static_cast<unsigned>(GetParam())};
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> share_{0, 1};
};

TEST_P(SensorLaw, ANoisyWallStaysWhereItIsAndDoesNotMove) {
  Background background(kCamera, {});
  double moving = 0;
  for (int i = 0; i < 90; ++i) {
    const Layers layers = background.learn(frame(i, 2, 7, 1));
    const auto count =
        std::ranges::count_if(layers.moving.units, [](std::uint16_t units) { return units > 0; });
    if (i >= 30) moving += static_cast<double>(count) / (40 * 30 * 60);
  }
  EXPECT_LT(moving, 0.003);
  const DepthImage surfaces = background.surfaces();
  std::vector<double> off_m;
  for (int v = 0; v < 30; ++v)
    for (int u = 27; u < 40; ++u)  // from 5.5 m on
      off_m.push_back(1e-3 * surfaces.units[static_cast<std::size_t>(v * 40 + u)] - (2 + 5.0 * u / 39));
  std::ranges::nth_element(off_m, off_m.begin() + static_cast<std::ptrdiff_t>(off_m.size() / 2));
  EXPECT_NEAR(off_m[off_m.size() / 2], 0, 0.015) << "where a noisy return was taken for a wall that left";
}

TEST_P(SensorLaw, RareReturnsAddUpToTheRoom) {
  Background background(kCamera, {});
  for (int i = 0; i < 90; ++i) (void)background.learn(frame(i, 3, 4, 0.2, 0.0005, 0));
  EXPECT_LT(std::ranges::count(background.surfaces().units, 0), 40 * 30 / 20);
  EXPECT_NEAR(background.noise().missing, 0.8, 0.1);
}

TEST_P(SensorLaw, WhatLeavesBeforeNothingIsForgottenWhereReturnsAreSureAtOnceElseLater) {
  for (const double chance : {0.99, 0.3}) {
    Background background(kCamera, {});
    int i = 0;
    for (; i < 60; ++i) (void)background.learn(frame(i, 3, 3.2, chance, 0.0005, 0));
    const auto left = [&] { return 40 * 30 - std::ranges::count(background.surfaces().units, 0); };
    const int until = i + static_cast<int>((chance > 0.9 ? 1.5 : 6.0) / kPeriod_s);
    for (; i < until; ++i) (void)background.learn(frame(i, 3, 3.2, 0));
    EXPECT_LT(left(), 12) << chance;
  }
}

TEST_P(SensorLaw, ARestartKnowsTheSensorFromTheFirstFrame) {
  Background first(kCamera, {});
  for (int i = 0; i < 60; ++i) (void)first.learn(frame(i, 2, 7, 0.9));
  Background second(kCamera, {}, first.noise());
  (void)second.learn(frame(0, 2, 7, 1));
  const Layers layers = second.learn(frame(1, 2, 7, 1));
  const auto moving = std::ranges::count_if(layers.moving.units, [](std::uint16_t units) { return units > 0; });
  EXPECT_LT(moving, 40 * 30 / 50);
}

INSTANTIATE_TEST_SUITE_P(Seeds, SensorLaw, testing::Range(1, 6));

}  // namespace
}  // namespace liloc
