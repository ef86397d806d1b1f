#include "server/global_cloud/background.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace liloc {
namespace {

const Camera kCamera{40, 30, 30.0, 30.0, 19.5, 14.5, 0.001};
constexpr StampNs kT0 = 1'700'000'000'000'000'000;

/// A wall at 4 m and something 1.5 m before it in columns from..to.
DepthImage with_visitor(double at_s, int from, int to) {
  DepthImage image{kT0 + from_seconds(at_s), 40, 30, std::vector<std::uint16_t>(40 * 30, 4000)};
  for (int v = 0; v < 30; ++v)
    for (int u = from; u < to; ++u) image.units[static_cast<std::size_t>(v * 40 + u)] = 2500;
  return image;
}

std::ptrdiff_t count(const DepthImage& image, std::uint16_t units) {
  return std::count(image.units.begin(), image.units.end(), units);
}

TEST(Background, WhatOnlyTremblesIsShownAsItWas) {
  Background background(kCamera, {});
  std::mt19937 rng(7);
  const auto frame = [&](int i, int wall_units) {
    DepthImage image = with_visitor(0.1 * i, 0, 0);
    for (std::uint16_t& units : image.units) units = static_cast<std::uint16_t>(wall_units + rng() % 9 - 4);
    (void)background.learn(image);
  };
  for (int i = 0; i < 40; ++i) frame(i, 4000);
  const DepthImage first = background.surfaces();
  for (int i = 40; i < 80; ++i) frame(i, 4001);
  EXPECT_EQ(background.surfaces().units, first.units) << "1 mm and noise of 4";
  for (int i = 80; i < 140; ++i) frame(i, 4040);
  for (const std::uint16_t units : background.surfaces().units) EXPECT_NEAR(units, 4040, 6);
}

TEST(Background, WhoWalksByIsTakenOutWithARim) {
  Background background(kCamera, {});
  EXPECT_EQ(count(background.learn(with_visitor(0, 0, 0)).still, 4000), 40 * 30);
  for (int i = 1; i < 20; ++i) {
    const auto [still, moving, gone] = background.learn(with_visitor(0.15 * i, i, i + 6));
    EXPECT_EQ(count(still, 2500), 0) << "frame " << i;
    EXPECT_EQ(count(still, 0), 8 * 30) << "frame " << i;
    EXPECT_EQ(count(moving, 2500), 6 * 30) << "frame " << i;
    EXPECT_EQ(count(moving, 4000), 0) << "the wall beside somebody does not move, frame " << i;
  }
}

TEST(Background, WhatStaysBecomesMapWithinSeconds) {
  Background background(kCamera, {});
  (void)background.learn(with_visitor(0, 0, 0));
  for (int i = 1; i <= 18; ++i) {
    const DepthImage still = background.learn(with_visitor(0.15 * i, 10, 16)).still;
    EXPECT_EQ(count(still, 2500), 0.15 * i < 2.2 ? 0 : 6 * 30) << "at " << 0.15 * i << " s";
  }
}

TEST(Background, AClockThatWasSetForwardByYearsChangesNothing) {
  Background background(kCamera, {});
  (void)background.learn(with_visitor(-3e8, 0, 0));
  for (int i = 1; i <= 18; ++i) {
    const DepthImage still = background.learn(with_visitor(0.15 * i, 10, 16)).still;
    EXPECT_EQ(count(still, 2500), 0.15 * i < 2.2 ? 0 : 6 * 30) << "at " << 0.15 * i << " s";
  }
}

TEST(Background, WhatLeavesUncoversMapAtOnce) {
  Background background(kCamera, {});
  for (int i = 0; i < 5; ++i) EXPECT_EQ(count(background.learn(with_visitor(0.15 * i, 10, 16)).still, 0), 0);
  (void)background.learn(with_visitor(1.00, 0, 0));
  EXPECT_EQ(count(background.learn(with_visitor(1.15, 0, 0)).still, 4000), 40 * 30);
  EXPECT_EQ(background.change(), Change::large);
  EXPECT_EQ(count(background.surfaces(), 4000), 40 * 30);
}

/// Columns 10 to 15 at a depth of their own; 0: no return.
DepthImage with_columns_at(double at_s, std::uint16_t units) {
  DepthImage image = with_visitor(at_s, 10, 16);
  std::ranges::replace(image.units, std::uint16_t{2500}, units);
  return image;
}

TEST(Background, WhoStoodAndWalksAwayIsGoneAtHisFirstStep) {
  Background background(kCamera, {});
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(background.learn(with_columns_at(0.15 * i, 2500)).gone.units.empty());
  (void)background.surfaces();
  for (int i = 0; i < 4; ++i)  // two depths in a row never agree, so that nothing is known of what is there now
    EXPECT_EQ(
        count(
            background.learn(with_columns_at(0.75 + 0.15 * i, static_cast<std::uint16_t>(2700 + 300 * i))).gone,
            2500),
        6 * 30)
        << "frame " << i;
  (void)background.learn(with_columns_at(1.5, 2500));
  EXPECT_TRUE(background.learn(with_columns_at(1.65, 2500)).gone.units.empty()) << "he is back";
}

TEST(Background, WhoLeavesWhereNothingReturnsIsGoneAtTheSecondFrameWithoutAReturn) {
  Background background(kCamera, {});
  for (int i = 0; i < 40; ++i) (void)background.learn(with_columns_at(0.15 * i, 2500));
  (void)background.surfaces();
  EXPECT_EQ(count(background.learn(with_columns_at(6.00, 0)).gone, 2500), 0) << "a return may be missing once";
  EXPECT_EQ(count(background.learn(with_columns_at(6.15, 0)).gone, 2500), 6 * 30);
  EXPECT_EQ(count(background.surfaces(), 2500), 6 * 30) << "it is forgotten after a second";
  for (int i = 0; i < 10; ++i) (void)background.learn(with_columns_at(6.30 + 0.15 * i, 0));
  EXPECT_EQ(count(background.learn(with_columns_at(7.80, 0)).gone, 2500), 6 * 30)
      << "until it is shown no more";
  EXPECT_EQ(count(background.surfaces(), 2500), 0);
  EXPECT_TRUE(background.learn(with_columns_at(7.95, 0)).gone.units.empty());
}

TEST(Background, APixelAloneThatLooksFartherIsNoise) {
  Background background(kCamera, {});
  for (int i = 0; i < 5; ++i) (void)background.learn(with_visitor(0.15 * i, 10, 16));
  (void)background.surfaces();
  DepthImage image = with_visitor(0.75, 10, 16);
  image.units[15 * 40 + 12] = 3900;
  EXPECT_TRUE(background.learn(image).gone.units.empty());
}

TEST(Background, WhoCameNearerSinceTheFirstFramesLeavesNoGhost) {
  Background background(kCamera, {});
  for (int i = 0; i < 8; ++i) {  // he walks towards the LiDAR: nobody sees yet what is behind him
    DepthImage image = with_visitor(0.15 * i, 10, 16);
    for (std::uint16_t& units : image.units)
      if (units == 2500) units = static_cast<std::uint16_t>(3000 - 200 * i);
    (void)background.learn(image);
    const DepthImage surfaces = background.surfaces();
    EXPECT_EQ(count(surfaces, 3000), i == 0 ? 6 * 30 : 0) << "frame " << i;
    EXPECT_EQ(count(surfaces, 4000), 34 * 30) << "frame " << i;
  }
}

TEST(Background, AGhostThatVanishesIsAChangeOnce) {
  Background background(kCamera, {});
  const auto at = [&](int i, std::uint16_t units) {
    DepthImage image = with_visitor(0.15 * i, 10, 16);
    for (std::uint16_t& u : image.units)
      if (u == 2500) u = units;
    (void)background.learn(image);
  };
  at(0, 2500);
  (void)background.surfaces();
  at(1, 2200);
  EXPECT_EQ(background.change(), Change::large);
  (void)background.surfaces();
  at(2, 2500);
  (void)background.surfaces();  // of the third frame, for its means
  at(3, 2200);
  EXPECT_EQ(background.change(), Change::none);
}

TEST(Background, ACalmRoomIsDerivedOnce) {
  Background background(kCamera, {});
  (void)background.learn(with_visitor(0, 0, 0));
  EXPECT_EQ(background.change(), Change::large);
  for (int i = 1; i < 4; ++i) (void)background.learn(with_visitor(0.15 * i, 0, 0));
  (void)background.surfaces();
  for (int i = 4; i < 24; ++i) {
    (void)background.learn(with_visitor(0.15 * i, i, i + 6));
    EXPECT_EQ(background.change(), i == 9 ? Change::large : Change::none) << "someone walks by at " << 0.15 * i;
  }
}

TEST(Background, MeansBecomeBetterThanFrames) {
  Background background(kCamera, {});
  for (int i = 0; i < 12; ++i) {
    DepthImage image = with_visitor(0.15 * i, 0, 0);
    for (std::size_t p = 0; p < image.units.size(); ++p)
      image.units[p] = static_cast<std::uint16_t>(3980 + (p * 31 + static_cast<std::size_t>(i) * 17) % 41);
    (void)background.learn(image);
  }
  const DepthImage surfaces = background.surfaces();
  double squared = 0;
  for (const std::uint16_t units : surfaces.units) squared += std::pow(units - 4000.0, 2);
  EXPECT_LT(std::sqrt(squared / static_cast<double>(surfaces.units.size())), 6.0);  // a frame's is 11.8
}

TEST(Background, WhereNothingReturnsAVisitorLeavesNoGhost) {
  Background background(kCamera, {});
  const auto over_nothing = [](double at_s, int from, int to) {  // the wall is too far to be seen
    DepthImage image = with_visitor(at_s, from, to);
    std::replace(image.units.begin(), image.units.end(), std::uint16_t{4000}, std::uint16_t{0});
    return image;
  };
  (void)background.learn(over_nothing(0, 5, 11));
  for (int i = 1; i < 12; ++i) (void)background.learn(over_nothing(0.15 * i, 10 + i, 16 + i));
  EXPECT_EQ(count(background.surfaces(), 0), 40 * 30);
}

TEST(Background, NoiseAndGapsMoveNothing) {
  Background background(kCamera, {});
  for (int i = 0; i < 20; ++i) {
    DepthImage image = with_visitor(0.15 * i, 0, 0);
    for (std::size_t p = 0; p < image.units.size(); ++p)
      image.units[p] =
          i > 0 && (p * 7 + static_cast<std::size_t>(i)) % 11 == 0
              ? std::uint16_t{0}
              : static_cast<std::uint16_t>(4000 + (p * 31 + static_cast<std::size_t>(i) * 17) % 60);
    const auto gaps = count(image, 0);
    const auto [still, moving, gone] = background.learn(image);
    EXPECT_EQ(count(still, 0), gaps);
    EXPECT_EQ(count(moving, 0), 40 * 30);
  }
}

TEST(Background, AReturnWhereOneWasLackingIsTheRoomsIfItContinuesIt) {
  Background background(kCamera, {});
  for (int i = 0; i < 12; ++i) {
    DepthImage image = with_visitor(0.15 * i, 0, 0);
    std::ptrdiff_t fresh = 0;
    for (std::size_t p = 0; p < image.units.size(); ++p) {
      const std::size_t first_at = p % 5 == 0 ? p * 13 % 12 : 0;  // one pixel in five is dark for up to 2 s
      if (static_cast<std::size_t>(i) < first_at) image.units[p] = 0;
      fresh += static_cast<std::size_t>(i) == first_at && i > 0 ? 1 : 0;
    }
    const auto gaps = count(image, 0);
    const auto [still, moving, gone] = background.learn(image);
    EXPECT_EQ(fresh > 0, i > 0) << "frame " << i;
    EXPECT_EQ(count(moving, 0), 40 * 30) << "frame " << i;
    EXPECT_TRUE(i < 4 || count(still, 0) == gaps) << "frame " << i;
  }
}

TEST(Background, APixelAloneIsNoiseAndTakesNothingAlong) {
  Background background(kCamera, {});
  for (int i = 0; i < 20; ++i) {
    DepthImage image = with_visitor(0.15 * i, 0, 0);
    const auto at = static_cast<std::size_t>(40 * (1 + i) + 2 * i);
    if (i > 0) image.units[at] = i % 2 == 0 ? 2500 : 5500;
    const auto [still, moving, gone] = background.learn(image);
    EXPECT_EQ(count(still, 4000), 40 * 30 - (i > 0 ? 1 : 0)) << "frame " << i;
    EXPECT_EQ(count(moving, 0), 40 * 30) << "frame " << i;
  }
}

TEST(Background, AVisitorBeforeNothingIsNotTakenForTheRoomBesideHim) {
  Background background(kCamera, {});
  const auto half_dark = [](double at_s, int from, int to) {  // beyond column 20 the room returns nothing
    DepthImage image = with_visitor(at_s, 0, 0);
    for (std::size_t p = 0; p < image.units.size(); ++p) {
      const auto u = static_cast<int>(p % 40);
      if (u >= 20) image.units[p] = 0;
      if (u >= from && u < to) image.units[p] = 2500;
    }
    return image;
  };
  for (int i = 0; i < 8; ++i) (void)background.learn(half_dark(0.15 * i, 0, 0));
  for (int i = 8; i < 20; ++i)
    EXPECT_EQ(count(background.learn(half_dark(0.15 * i, 8 + i, 14 + i)).moving, 2500), 6 * 30) << i;
}

}  // namespace
}  // namespace liloc
