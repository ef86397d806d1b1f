#include "server/ingest/lidar_monitor.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

using namespace std::chrono_literals;
using wire::LidarState;

const LidarMonitor::Time kStart{1000s};
constexpr FrameContent kRoom{0.9, 1.0, 2.5, 4.5}, kNothing{};

/// A LiDAR at 10 Hz that shows each of these for some seconds; its state after the last.
LidarState state_after(const std::vector<std::pair<FrameContent, int>>& shown, double height_m = 0) {
  LidarMonitor monitor("ceiling0", 10, kStart, height_m);
  auto now = kStart;
  for (const auto& [content, seconds] : shown)
    for (int i = 0; i < 10 * seconds; ++i) monitor.on_frame(now += 100ms, content);
  return monitor.assess(now).state;
}

/// The room in another unit.
FrameContent in_units_of(double factor) {
  return {0.9, factor > 2 ? 0.05 : factor < 0.1 ? 0.0 : 0.9, factor * kRoom.range_m, factor * kRoom.far_m};
}

TEST(LidarMonitor, FramesWithoutReturnsAreBlind) {
  EXPECT_EQ(state_after({{kNothing, 1}}), LidarState::blind);
  EXPECT_EQ(state_after({{kRoom, 10}, {kNothing, 3}}), LidarState::blind);
  EXPECT_EQ(state_after({{kNothing, 3}, {kRoom, 2}}), LidarState::ok);
  EXPECT_EQ(state_after({{{0.3, 1, 2.5, 4.5}, 3}}), LidarState::ok) << "many missing returns are no blindness";
}

TEST(LidarMonitor, AWrongUnitIsImplausibleFromTheStart) {
  for (const double factor : {0.001, 0.1, 0.25, 4.0, 10.0, 1000.0})
    EXPECT_EQ(state_after({{in_units_of(factor), 2}}), LidarState::implausible) << factor;
}

TEST(LidarMonitor, AUnitThatLiftsTheFloorIsImplausibleThoughItsRangesAreNot) {
  const auto state = [](double height_m, double factor) {  // a LiDAR in a corner sees twice as far as down
    const FrameContent content{0.9, 1, 1.2 * factor * height_m, 2 * factor * height_m, factor * height_m};
    return state_after({{content, 2}}, height_m);
  };
  for (const double height_m : {3.4, 5.0, 6.5, 8.0}) {
    EXPECT_EQ(state(height_m, 0.25), LidarState::implausible) << height_m << ": 0.00025 for 0.001";
    EXPECT_EQ(state(height_m, 1.01), LidarState::ok) << height_m;
  }
  EXPECT_EQ(state(3.4, 0.4), LidarState::implausible) << "0.0001 for 0.00025";
  EXPECT_EQ(state(2.6, 2.5), LidarState::implausible) << "0.00025 for 0.0001";
}

TEST(LidarMonitor, AMapWhoseZeroIsNotTheFloorIsNoWrongUnit) {
  // Height over z = 0, and over the floor.
  for (const auto& [height_m, drop_m] :
       {std::pair{0.0, 2.6}, {-1.0, 2.6}, {1.2, 3.0}, {5.9, 2.7}, {10.8, 2.7}, {520.0, 2.6}})
    EXPECT_EQ(state_after({{{0.9, 1, 2.8, 5, drop_m}, 2}}, height_m), LidarState::ok) << height_m;
}

TEST(LidarMonitor, ARangeThreeTimesTheUsualIsImplausibleUntilItIsBack) {
  const FrameContent hall{0.9, 0.9, 2.0, 8.0}, other{0.9, 0.9, 8.0, 8.4};
  EXPECT_EQ(state_after({{hall, 10}}), LidarState::ok);
  EXPECT_EQ(state_after({{other, 10}}), LidarState::ok) << "neither is strange by itself";
  EXPECT_EQ(state_after({{hall, 10}, {other, 100}}), LidarState::implausible);
  EXPECT_EQ(state_after({{hall, 10}, {other, 100}, {hall, 3}}), LidarState::ok);
}

TEST(LidarMonitor, ACrowdBeforeItIsPlausible) {
  EXPECT_EQ(state_after({{kRoom, 10}, {{0.8, 1, 1.3, 3.5}, 60}}), LidarState::ok);
}

TEST(LidarMonitor, TellsWhatItSeesAndUsedToSee) {
  LidarMonitor monitor("ceiling0", 10, kStart);
  auto now = kStart;
  for (int i = 0; i < 100; ++i) monitor.on_frame(now += 100ms, kRoom);
  const auto health = monitor.assess(now);
  EXPECT_DOUBLE_EQ(health.returns, 0.9);
  EXPECT_DOUBLE_EQ(health.range_m, 2.5);
  EXPECT_NEAR(health.usual_range_m, 2.5, 1e-9);
}

TEST(LidarMonitor, WaitsAtFirstThenIsSilent) {
  const LidarMonitor monitor("ceiling0", 10, kStart);
  EXPECT_EQ(monitor.assess(kStart + 500ms).state, LidarState::waiting);
  EXPECT_EQ(monitor.assess(kStart + 1100ms).state, LidarState::silent);
}

TEST(LidarMonitor, FallsSilentAndComesBack) {
  LidarMonitor monitor("ceiling0", 10, kStart);
  auto now = kStart;
  for (int i = 0; i < 50; ++i) monitor.on_frame(now += 100ms, kRoom);
  EXPECT_EQ(monitor.assess(now).state, LidarState::ok);
  EXPECT_NEAR(monitor.assess(now).measured_hz, 10, 1);
  EXPECT_EQ(monitor.assess(now + 1100ms).state, LidarState::silent);
  now += 10s;
  for (int i = 0; i < 30; ++i) {
    monitor.on_frame(now += 100ms, kRoom);
    EXPECT_EQ(monitor.assess(now).state, LidarState::ok) << "not slow for its silence, frame " << i;
  }
  EXPECT_EQ(monitor.assess(now).state, LidarState::ok);
  EXPECT_EQ(monitor.assess(now).frames, 80U);
}

TEST(LidarMonitor, IsSlowUnderHalfTheExpectedRate) {
  LidarMonitor monitor("ceiling0", 10, kStart);
  auto now = kStart;
  for (int i = 0; i < 30; ++i) monitor.on_frame(now += 250ms, kRoom);
  EXPECT_EQ(monitor.assess(now).state, LidarState::slow);
  for (int i = 0; i < 30; ++i) monitor.on_frame(now += 125ms, kRoom);
  EXPECT_EQ(monitor.assess(now).state, LidarState::ok);
}

TEST(LidarMonitor, NamesWhatIsMalformedUntilAGoodFrameComes) {
  LidarMonitor monitor("ceiling0", 10, kStart);
  monitor.on_frame(kStart + 100ms, kRoom);
  monitor.on_malformed(kStart + 150ms, "step is 1");
  EXPECT_EQ(monitor.assess(kStart + 160ms).state, LidarState::ok)
      << "one bad frame among good ones is only counted";
  monitor.on_malformed(kStart + 200ms, "step is 2");
  monitor.on_malformed(kStart + 200ms, "step is 3");
  const auto health = monitor.assess(kStart + 250ms);
  EXPECT_EQ(health.state, LidarState::malformed);
  EXPECT_EQ(health.malformed, 3U);
  EXPECT_EQ(health.last_error, "step is 3");
  monitor.on_frame(kStart + 300ms, kRoom);
  EXPECT_EQ(monitor.assess(kStart + 350ms).state, LidarState::ok);
}

TEST(LidarMonitor, KnowsHowOldItsNewestGoodFrameIs) {
  LidarMonitor monitor("ceiling0", 10, kStart);
  EXPECT_FALSE(monitor.age_s(kStart + 1s));
  monitor.on_frame(kStart + 2s, kRoom);
  monitor.on_malformed(kStart + 3s, "step");
  EXPECT_DOUBLE_EQ(monitor.age_s(kStart + 4s).value(), 2);
}

TEST(LidarMonitor, ASlowLidarHasFivePeriodsBeforeItIsSilent) {
  LidarMonitor monitor("ceiling0", 1, kStart);
  monitor.on_frame(kStart + 1s, kRoom);
  EXPECT_NE(monitor.assess(kStart + 5s).state, LidarState::silent);
  EXPECT_EQ(monitor.assess(kStart + 7s).state, LidarState::silent);
}

}  // namespace
}  // namespace liloc
