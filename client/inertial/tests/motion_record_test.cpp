#include "client/inertial/motion_record.hpp"

#include <gtest/gtest.h>

#include <random>

namespace liloc {
namespace {

constexpr StampNs kStart_ns = 1'700'000'000'000'000'000;

StampNs at(double seconds) {
  return kStart_ns + from_seconds(seconds);
}

SeenStep step(double from_s, double to_s) {
  return {at(from_s), at(to_s)};
}

class MotionRecordLaw : public testing::TestWithParam<unsigned> {};

/// Rates and forces that change evenly, whose means are their middles wherever a step begins and ends.
TEST_P(MotionRecordLaw, WhatWasFeltIsTheMeanOverTheStep) {
  std::mt19937 rng(GetParam());
  std::normal_distribution<double> unit(0, 1);
  const auto random = [&] { return Eigen::Vector3d(unit(rng), unit(rng), unit(rng)); };
  const Eigen::Vector3d w = random(), w_change = random(), a = random(), a_change = random();
  MotionRecord record;
  std::uniform_real_distribution<double> dt_s(0.001, 0.009);
  for (double t = 0; t < 3; t += dt_s(rng)) record.feel({at(t), w + t * w_change, a + t * a_change});
  for (const auto& [from, to] : {std::pair{0.1, 0.2}, {1.0, 2.5}, {2.033, 2.1}}) {
    const auto felt = record.felt(step(from, to));
    ASSERT_TRUE(felt);
    const double middle = 0.5 * (from + to);
    // Between two samples the sums are taken for straight: off by an eighth of dt^2 times the change.
    EXPECT_LT((felt->rate_rad_s - (w + middle * w_change)).norm(), 1e-3);
    EXPECT_LT((felt->force_m_s2 - (a + middle * a_change)).norm(), 1e-3);
  }
}

TEST_P(MotionRecordLaw, StampsThatAreAheadAreLookedUpThereUntilTheyAreTakenOff) {
  std::mt19937 rng(GetParam());
  std::normal_distribution<double> unit(0, 1);
  MotionRecord right, ahead;
  constexpr StampNs kAhead_ns = from_ms(700);
  for (double t = 0; t < 4; t += 0.005) {
    const ImuSample sample{at(t), {unit(rng), unit(rng), unit(rng)}, {0, 0, 9.81}};
    right.feel(sample);
    ahead.feel({sample.stamp_ns + kAhead_ns, sample.angular_velocity_rad_s, sample.specific_force_m_s2});
  }
  const Eigen::Vector3d rate = right.felt(step(1, 1.5))->rate_rad_s;
  EXPECT_LT((ahead.felt(step(1, 1.5), kAhead_ns)->rate_rad_s - rate).norm(), 1e-9);
  EXPECT_GT((ahead.felt(step(1, 1.5))->rate_rad_s - rate).norm(), 1e-3);
  ahead.take_off(kAhead_ns);
  EXPECT_LT((ahead.felt(step(1, 1.5))->rate_rad_s - rate).norm(), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Seeds, MotionRecordLaw, testing::Range(1U, 6U));

MotionRecord turning(double from_s, double to_s) {
  MotionRecord record;
  for (double t = from_s; t < to_s; t += 0.005) record.feel({at(t), {0, 0, 1}, {0, 0, 9.81}});
  return record;
}

TEST(MotionRecord, WhatIsNotAllKnownWasNotFelt) {
  MotionRecord record = turning(1, 2);
  EXPECT_TRUE(record.felt(step(1.1, 1.9)));
  EXPECT_FALSE(record.felt(step(0.9, 1.5)));
  EXPECT_FALSE(record.felt(step(1.5, 2.1)));
  for (double t = 2.2; t < 3; t += 0.005) record.feel({at(t), {0, 0, 1}, {0, 0, 9.81}});
  EXPECT_FALSE(record.felt(step(2.1, 2.5))) << "it begins in a gap of 0.2 s";
  EXPECT_TRUE(record.felt(step(2.3, 2.5)));
}

TEST(MotionRecord, AStampThatDoesNotRiseBeginsAnew) {
  MotionRecord record = turning(1, 2);
  record.feel({at(1.2), {0, 0, 1}, {0, 0, 9.81}});
  EXPECT_FALSE(record.felt(step(1.1, 1.9)));
}

TEST(MotionRecord, KeepsTheLastSecondsAlone) {
  MotionRecord record = turning(0, 30);
  EXPECT_FALSE(record.felt(step(10, 11)));
  EXPECT_TRUE(record.felt(step(13, 14)));
  for (int i = 0; i < 100; ++i) record.see(step(i, i + 1));
  EXPECT_EQ(record.seen().size(), 15U);
  EXPECT_EQ(record.seen().back().to_ns, at(100));
  record.forget_seen();
  EXPECT_TRUE(record.seen().empty());
}

}  // namespace
}  // namespace liloc
