#include "server/ingest/site_clocks.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace liloc {
namespace {

using namespace std::chrono_literals;

constexpr StampNs kWall = 1'700'000'000'000'000'000;

/// LiDARs at 10 Hz, each clock off by so much; the host's clock shows `kWall` at the start.
struct Ceiling {
  explicit Ceiling(std::vector<double> off_s, StampNs host_ns = kWall)
      : off(std::move(off_s)), wall_ns(host_ns), clocks(off.size()) {}

  /// A frame of each LiDAR, `late_ms` after it was taken.
  void frame(StampNs late_ns = from_ms(20)) {
    at += 100ms;
    truth_ns += from_ms(100);
    wall_ns += from_ms(100);
    last.clear();
    for (std::size_t i = 0; i < off.size(); ++i)
      last.push_back(clocks.add(i, truth_ns - late_ns + from_seconds(off[i]), at, wall_ns));
  }
  void run(double seconds) {
    for (int i = 0; i < static_cast<int>(10 * seconds); ++i) frame();
  }
  /// How far the site's clock is from the true one, less the frames' delay.
  [[nodiscard]] double site_off_s() const { return to_seconds(*clocks.now(at) - truth_ns + from_ms(20)); }

  std::vector<double> off;
  StampNs wall_ns, truth_ns = kWall;
  SiteClocks clocks;
  SiteClocks::Time at{1000s};
  std::vector<std::optional<StampNs>> last{};
};

TEST(SiteClocks, ClocksThatAgreePassAsTheyAre) {
  Ceiling ceiling({0, 0.03, -0.02});
  ceiling.run(3);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(ceiling.last[i], ceiling.truth_ns - from_ms(20) + from_seconds(ceiling.off[i]));
    EXPECT_FALSE(ceiling.clocks.offset(i).corrected);
  }
}

TEST(SiteClocks, OneAheadIsLeftOutAtFirstThenCorrectedAndTold) {
  for (const double off_s : {37.0, -37.0, 0.8, 1e6}) {
    Ceiling ceiling({0, off_s, 0, 0});
    ceiling.run(1);
    EXPECT_FALSE(ceiling.last[1]) << off_s;
    EXPECT_TRUE(ceiling.clocks.offset(1).left_out);
    ceiling.run(3);
    ASSERT_TRUE(ceiling.last[1]) << off_s;
    EXPECT_NEAR(to_seconds(*ceiling.last[1] - *ceiling.last[0]), 0, 0.05);
    EXPECT_NEAR(to_seconds(ceiling.clocks.offset(1).ahead_ns), off_s, 0.05);
    EXPECT_TRUE(ceiling.clocks.offset(1).corrected);
    EXPECT_NEAR(ceiling.site_off_s(), 0, 0.05);
  }
}

TEST(SiteClocks, TwoOfFourAheadDoNotCarryTheSiteAway) {
  Ceiling ceiling({37, 37, 0, 0});  // the two that are off are heard first
  ceiling.run(5);
  EXPECT_NEAR(ceiling.site_off_s(), 0, 0.05);
  for (const std::size_t i : {0U, 1U}) EXPECT_TRUE(ceiling.clocks.offset(i).corrected);
}

TEST(SiteClocks, InATieOfStampsThatAreNoTimeOfDayTheClockGoneByBeforeStays) {
  Ceiling ceiling({0, 0, 0, 0}, 2 * kWall);
  ceiling.run(3);
  ceiling.off = {37, 37, 0, 0};
  ceiling.run(5);
  EXPECT_NEAR(ceiling.site_off_s(), 0, 0.05);
  EXPECT_TRUE(ceiling.clocks.offset(0).corrected);
  EXPECT_FALSE(ceiling.clocks.offset(2).corrected);
}

TEST(SiteClocks, TheMajorityIsRightWhateverTheHostsClockSays) {
  Ceiling ceiling({37, 0, 37, 37});
  ceiling.run(5);
  EXPECT_NEAR(ceiling.site_off_s(), 37, 0.05);
  EXPECT_NEAR(to_seconds(ceiling.clocks.offset(1).ahead_ns), -37, 0.05);
}

TEST(SiteClocks, AClockThatRunsAtAnotherRateIsLeftOut) {
  Ceiling ceiling({0, 0, 0});
  for (int i = 0; i < 100; ++i) {
    ceiling.off[1] += 0.1;  // two seconds a second
    ceiling.frame();
  }
  EXPECT_FALSE(ceiling.last[1]);
  EXPECT_TRUE(ceiling.clocks.offset(1).left_out);
  EXPECT_NEAR(ceiling.site_off_s(), 0, 0.05);
}

TEST(SiteClocks, AClockThatIsMendedPassesAsItIs) {
  Ceiling ceiling({0, 37, 0});
  ceiling.run(4);
  ceiling.off[1] = 0;
  ceiling.run(3);
  EXPECT_EQ(ceiling.last[1], ceiling.last[0]);
  EXPECT_FALSE(ceiling.clocks.offset(1).corrected);
}

TEST(SiteClocks, NothingHeardIsNoClock) {
  SiteClocks clocks(2);
  EXPECT_FALSE(clocks.now(SiteClocks::Time{1000s}));
}

/// 50 parts in a million: a cheap oscillator.
TEST(SiteClocks, ACorrectedClockThatDriftsIsFollowed) {
  Ceiling ceiling({0, 37, 0, 0});
  ceiling.run(3);
  int left_out = 0;
  for (int i = 0; i < 36'000; ++i) {  // an hour
    ceiling.off[1] += 0.1 * 50e-6;
    ceiling.frame();
    left_out += ceiling.last[1] ? 0 : 1;
    if (ceiling.last[1]) {
      ASSERT_LT(std::abs(to_seconds(*ceiling.last[1] - *ceiling.last[0])), 0.01) << i;
    }
  }
  EXPECT_EQ(left_out, 0);
}

}  // namespace
}  // namespace liloc
