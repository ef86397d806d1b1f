#include "server/ingest/lidar_monitor.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

using namespace std::chrono_literals;
using wire::LidarState;

const LidarMonitor::Time kStart{1000s};

TEST(LidarMonitor, WaitsAtFirstThenIsSilent) {
  const LidarMonitor monitor("ceiling0", 10, kStart);
  EXPECT_EQ(monitor.assess(kStart + 500ms).state, LidarState::waiting);
  EXPECT_EQ(monitor.assess(kStart + 1100ms).state, LidarState::silent);
}

TEST(LidarMonitor, FallsSilentAndComesBack) {
  LidarMonitor monitor("ceiling0", 10, kStart);
  auto now = kStart;
  for (int i = 0; i < 50; ++i) monitor.on_frame(now += 100ms);
  EXPECT_EQ(monitor.assess(now).state, LidarState::ok);
  EXPECT_NEAR(monitor.assess(now).measured_hz, 10, 1);
  EXPECT_EQ(monitor.assess(now + 1100ms).state, LidarState::silent);
  now += 10s;
  for (int i = 0; i < 30; ++i) {
    monitor.on_frame(now += 100ms);
    EXPECT_EQ(monitor.assess(now).state, LidarState::ok) << "not slow for its silence, frame " << i;
  }
  EXPECT_EQ(monitor.assess(now).state, LidarState::ok);
  EXPECT_EQ(monitor.assess(now).frames, 80U);
}

TEST(LidarMonitor, IsSlowUnderHalfTheExpectedRate) {
  LidarMonitor monitor("ceiling0", 10, kStart);
  auto now = kStart;
  for (int i = 0; i < 30; ++i) monitor.on_frame(now += 250ms);
  EXPECT_EQ(monitor.assess(now).state, LidarState::slow);
  for (int i = 0; i < 30; ++i) monitor.on_frame(now += 125ms);
  EXPECT_EQ(monitor.assess(now).state, LidarState::ok);
}

TEST(LidarMonitor, NamesWhatIsMalformedUntilAGoodFrameComes) {
  LidarMonitor monitor("ceiling0", 10, kStart);
  monitor.on_frame(kStart + 100ms);
  monitor.on_malformed(kStart + 150ms, "step is 1");
  EXPECT_EQ(monitor.assess(kStart + 160ms).state, LidarState::ok)
      << "one bad frame among good ones is only counted";
  monitor.on_malformed(kStart + 200ms, "step is 2");
  monitor.on_malformed(kStart + 200ms, "step is 3");
  const auto health = monitor.assess(kStart + 250ms);
  EXPECT_EQ(health.state, LidarState::malformed);
  EXPECT_EQ(health.malformed, 3U);
  EXPECT_EQ(health.last_error, "step is 3");
  monitor.on_frame(kStart + 300ms);
  EXPECT_EQ(monitor.assess(kStart + 350ms).state, LidarState::ok);
}

TEST(LidarMonitor, KnowsHowOldItsNewestGoodFrameIs) {
  LidarMonitor monitor("ceiling0", 10, kStart);
  EXPECT_FALSE(monitor.age_s(kStart + 1s));
  monitor.on_frame(kStart + 2s);
  monitor.on_malformed(kStart + 3s, "step");
  EXPECT_DOUBLE_EQ(monitor.age_s(kStart + 4s).value(), 2);
}

TEST(LidarMonitor, ASlowLidarHasFivePeriodsBeforeItIsSilent) {
  LidarMonitor monitor("ceiling0", 1, kStart);
  monitor.on_frame(kStart + 1s);
  EXPECT_NE(monitor.assess(kStart + 5s).state, LidarState::silent);
  EXPECT_EQ(monitor.assess(kStart + 7s).state, LidarState::silent);
}

}  // namespace
}  // namespace liloc
