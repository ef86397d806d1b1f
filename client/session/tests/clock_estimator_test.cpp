#include "client/session/clock_estimator.hpp"

#include <gtest/gtest.h>

#include <random>

namespace liloc {
namespace {

constexpr StampNs kEpoch = 1'700'000'000'000'000'000;

/// Exchanges every 0.8 s over a network that delays each way by what is drawn from the seed.
class Network {
 public:
  Network(unsigned seed, double device_ahead_ms) : random_(seed), offset_ms(device_ahead_ms) {}
  ClockExchange exchange(double least_ms = 0.3, double mean_extra_ms = 4) {
    std::exponential_distribution<double> extra(1 / mean_extra_ms);
    const double out_ms = least_ms + extra(random_), back_ms = least_ms + extra(random_), work_ms = 15;
    now_ms_ += 800;
    const auto device = [&](double ms) { return kEpoch + from_ms(now_ms_ + ms + offset_ms); };
    const auto ceiling = [&](double ms) { return kEpoch + from_ms(now_ms_ + ms); };
    return {device(0), ceiling(out_ms), ceiling(out_ms + work_ms), device(out_ms + work_ms + back_ms)};
  }

 private:
  std::mt19937 random_;
  double now_ms_ = 0;

 public:
  double offset_ms;
};

class ClockLaw : public testing::TestWithParam<unsigned> {};

TEST_P(ClockLaw, TheOffsetIsFoundWithinHalfTheQuickestRoundTrip) {
  for (const double offset_ms : {70.0, -70.0, 0.0, 3.6e6}) {
    Network network(GetParam(), offset_ms);
    ClockEstimator clock;
    for (int i = 0; i < 20; ++i) EXPECT_FALSE(clock.add(network.exchange()));
    const auto found = clock.offset();
    ASSERT_TRUE(found && found->good);
    EXPECT_LE(std::abs(to_ms(found->offset_ns) - offset_ms), to_ms(found->round_trip_ns) / 2 + 1e-6);
    EXPECT_LT(to_ms(found->round_trip_ns), 8);
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, ClockLaw, testing::Range(1U, 17U));

TEST(ClockEstimator, AStampIsCorrectedOnlyWhereItMatters) {
  Network ahead(1, 70), in_step(2, 4), slow(3, 70);
  ClockEstimator a, b, c;
  EXPECT_FALSE(a.ceiling_stamp(kEpoch));  // nothing known
  static_cast<void>(a.add(ahead.exchange()));
  EXPECT_FALSE(a.ceiling_stamp(kEpoch));  // not enough known
  for (int i = 0; i < 20; ++i) {
    static_cast<void>(a.add(ahead.exchange()));
    static_cast<void>(b.add(in_step.exchange()));
    static_cast<void>(c.add(slow.exchange(200, 100)));
  }
  ASSERT_TRUE(a.ceiling_stamp(kEpoch));
  EXPECT_NEAR(to_ms(kEpoch - *a.ceiling_stamp(kEpoch)), 70, 4);
  EXPECT_FALSE(b.ceiling_stamp(kEpoch));  // small: it could only make things worse
  EXPECT_FALSE(c.ceiling_stamp(kEpoch));  // not known well enough
}

TEST(ClockEstimator, AJumpStartsAnewAndTwoAreNotNeeded) {
  Network network(4, 10);
  ClockEstimator clock;
  for (int i = 0; i < 20; ++i) ASSERT_FALSE(clock.add(network.exchange()));
  network.offset_ms = 500;
  EXPECT_FALSE(clock.add(network.exchange()));
  EXPECT_FALSE(clock.offset()->good);  // doubtful at once
  EXPECT_TRUE(clock.add(network.exchange()));
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(clock.add(network.exchange()));
  EXPECT_NEAR(to_ms(clock.offset()->offset_ns), 500, 5);
  EXPECT_TRUE(clock.offset()->good);
}

TEST(ClockEstimator, OneSlowExchangeIsNoJump) {
  Network network(5, 10);
  ClockEstimator clock;
  for (int i = 0; i < 10; ++i) ASSERT_FALSE(clock.add(network.exchange()));
  for (int i = 0; i < 3; ++i) EXPECT_FALSE(clock.add(network.exchange(300, 1)));
  EXPECT_NEAR(to_ms(clock.offset()->offset_ns), 10, 4);
}

TEST(ClockEstimator, WhatCannotBeIsLeftOut) {
  ClockEstimator clock;
  EXPECT_FALSE(clock.add({}));                                              // a server that knows no clock
  EXPECT_FALSE(clock.add({kEpoch, kEpoch + 10, kEpoch + 5, kEpoch + 20}));  // answered before it came
  EXPECT_FALSE(clock.add({kEpoch, kEpoch, kEpoch, kEpoch - 5}));            // back before it left
  EXPECT_FALSE(clock.add({kEpoch, kEpoch, kEpoch, kEpoch + from_seconds(10)}));
  EXPECT_FALSE(clock.offset());
}

}  // namespace
}  // namespace liloc
