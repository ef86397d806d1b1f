#include "common/base/stamp_clock.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

using namespace std::chrono_literals;

constexpr StampNs kEpoch = 1'700'000'000'000'000'000;
const StampClock::Time kStart = StampClock::Time(1000s);

/// Frames at 10 Hz whose clock is `kEpoch` at `kStart`.
struct Stream {
  StampClock clock;
  int frame = 0;
  StampNs shift_ns = 0;
  bool send(std::chrono::milliseconds delay) {
    const auto made = kStart + frame++ * 100ms;
    return clock.add(kEpoch + std::chrono::nanoseconds(made - kStart).count() + shift_ns, made + delay);
  }
  [[nodiscard]] double error_ms(StampClock::Time at) const {
    return to_ms(*clock.now(at) - kEpoch - std::chrono::nanoseconds(at - kStart).count() - shift_ns);
  }
};

TEST(StampClock, RunsOnBetweenStamps) {
  Stream s;
  for (int i = 0; i < 20; ++i) EXPECT_FALSE(s.send(0ms));
  EXPECT_NEAR(s.error_ms(kStart + 1930ms), 0, 1e-6);
}

TEST(StampClock, LateFramesDoNoHarm) {
  Stream s;
  for (int i = 0; i < 60; ++i)
    EXPECT_FALSE(s.send(i % 4 == 1 ? 5ms : std::chrono::milliseconds(20 + 7 * (i % 9))));
  EXPECT_NEAR(s.error_ms(kStart + 6s), -5, 1e-6);  // the delay they have in common
}

TEST(StampClock, IsUnknownBeforeAndAfterTheStream) {
  Stream s;
  EXPECT_FALSE(s.clock.now(kStart));
  s.send(0ms);
  EXPECT_TRUE(s.clock.now(kStart + 2s));
  EXPECT_FALSE(s.clock.now(kStart + 4s));
}

TEST(StampClock, AClockThatIsSetIsNoticedBothWays) {
  for (const double jump_s : {5.0, -5.0, 0.3, -0.3}) {
    Stream s;
    for (int i = 0; i < 20; ++i) EXPECT_FALSE(s.send(0ms));
    s.shift_ns = from_seconds(jump_s);
    int noticed = 0;
    for (int i = 0; i < 20; ++i) noticed += s.send(0ms);
    EXPECT_EQ(noticed, 1) << jump_s;
    EXPECT_NEAR(s.error_ms(kStart + 4s), 0, 1e-6) << jump_s;
  }
}

TEST(StampClock, ABusyMomentIsNoJump) {
  Stream s;
  for (int i = 0; i < 20; ++i) s.send(0ms);
  for (int i = 0; i < 4; ++i) EXPECT_FALSE(s.send(std::chrono::milliseconds(500 - 100 * i)));
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(s.send(0ms));
  EXPECT_NEAR(s.error_ms(kStart + 3s), 0, 1e-6);
}

}  // namespace
}  // namespace liloc
