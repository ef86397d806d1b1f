#include "common/base/stamp_watch.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace liloc {
namespace {

constexpr StampNs kEpoch = 1'700'000'000'000'000'000, kStep = from_ms(33);
constexpr StampNs kHour = from_seconds(3600);

StampWatch frames() {
  return StampWatch({"depth", from_ms(1), 3});
}

/// Feeds `count` stamps from `from_ns` on; how many were taken.
int feed(StampWatch& watch, StampNs from_ns, int count, StampNs step_ns = kStep) {
  int taken = 0;
  for (int i = 0; i < count; ++i) taken += watch.add(from_ns + i * step_ns).has_value();
  return taken;
}

std::string error_of(const Result<StampNs>& result) {
  return result ? "" : result.error().message;
}

TEST(StampWatch, TakesWhatRises) {
  StampWatch watch = frames();
  EXPECT_EQ(feed(watch, kEpoch, 100), 100);
  EXPECT_NE(error_of(watch.add(kEpoch + 99 * kStep)).find("not newer"), std::string::npos);
  EXPECT_EQ(*watch.add(kEpoch + from_seconds(9)), 0);  // a pause
}

class StampWatchLaw : public testing::TestWithParam<unsigned> {};

TEST_P(StampWatchLaw, ALoneStrayIsDroppedAndNothingElse) {
  std::mt19937 random(GetParam());
  StampWatch watch = frames();
  StampNs now = kEpoch;
  for (int i = 0; i < 200; ++i) {
    ASSERT_EQ(watch.add(now += kStep).value_or(1), 0);
    if (random() % 4 != 0) continue;
    const StampNs off = static_cast<StampNs>(random() % 2 == 0 ? 1 : -1) *
                        std::uniform_int_distribution<StampNs>(from_seconds(11), 100 * kHour)(random);
    EXPECT_FALSE(watch.add(now + off));
  }
}

TEST_P(StampWatchLaw, AClockThatWasSetIsFollowedAfterThree) {
  std::mt19937 random(GetParam());
  StampWatch watch = frames();
  feed(watch, kEpoch, 50);
  const StampNs last = kEpoch + 49 * kStep;
  const bool back = random() % 2 == 0;
  const StampNs by = back ? -std::uniform_int_distribution<StampNs>(from_ms(700), 100 * kHour)(random)
                          : std::uniform_int_distribution<StampNs>(from_seconds(11), 100 * kHour)(random);
  for (int i = 1; i < 3; ++i) EXPECT_FALSE(watch.add(last + by + i * kStep));
  const auto set = watch.add(last + by + 3 * kStep);
  ASSERT_TRUE(set);
  EXPECT_EQ(*set, by);
  EXPECT_EQ(feed(watch, last + by + 4 * kStep, 50), 50);
}
INSTANTIATE_TEST_SUITE_P(Seeds, StampWatchLaw, testing::Range(1U, 9U));

TEST(StampWatch, RepeatedAndSwappedStampsOfAClockSetBackDoNotHideIt) {
  StampWatch watch = frames();
  feed(watch, kEpoch, 50);
  const StampNs set = kEpoch - from_seconds(10);
  int taken = 0;
  for (const int i : {0, 0, 1, 1, 3, 2, 4, 4}) taken += watch.add(set + i * kStep).has_value();
  EXPECT_EQ(taken, 2);
}

TEST(StampWatch, LateOnesAreNoClockSetBack) {
  StampWatch watch = frames();
  feed(watch, kEpoch, 50);
  EXPECT_EQ(feed(watch, kEpoch + 35 * kStep, 14), 0);  // sent again
  EXPECT_EQ(*watch.add(kEpoch + 50 * kStep), 0);
}

TEST(StampWatch, UnitsAreNamedByTheRise) {
  const struct {
    StampNs from, step;
    const char* name;
  } wrong[] = {{kEpoch / 1'000, 33'000, "microseconds"}, {kEpoch / 1'000'000, 33, "milliseconds"}};
  for (const auto& unit : wrong) {
    StampWatch watch = frames();
    EXPECT_LE(feed(watch, unit.from, 200, unit.step), 2);
    EXPECT_NE(error_of(watch.add(unit.from + 200 * unit.step)).find(unit.name), std::string::npos);
    EXPECT_GE(feed(watch, kEpoch, 50), 46);  // and right again
  }
}

TEST(StampWatch, WhatWasNotSetIsRefused) {
  StampWatch watch = frames();
  for (const StampNs stamp : {StampNs{0}, StampNs{-1}, std::numeric_limits<StampNs>::min()})
    EXPECT_NE(error_of(watch.add(stamp)).find("not set"), std::string::npos);
  EXPECT_EQ(feed(watch, kEpoch, 50), 50);
  EXPECT_FALSE(watch.add(std::numeric_limits<StampNs>::max()));
}

TEST(StampUnits, AreNamedByTheWallClock) {
  const StampNs wall = kEpoch + kHour;
  const auto says = [&](StampNs stamp, const char* unit) {
    const Status status = check_unit_by(wall, stamp, "IMU");
    return !status && status.error().message.find(unit) != std::string::npos;
  };
  EXPECT_TRUE(says(wall / 1'000, "microseconds"));
  EXPECT_TRUE(says(wall / 1'000'000, "milliseconds"));
  EXPECT_TRUE(says(wall / 1'000'000'000, " seconds"));
  EXPECT_TRUE(says(-5, "not set"));
  for (const StampNs good : {wall, wall + 20'000 * kHour, from_seconds(5), 900 * kHour})
    EXPECT_TRUE(check_unit_by(wall, good, "IMU")) << good;
}

}  // namespace
}  // namespace liloc
