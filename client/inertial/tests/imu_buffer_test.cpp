#include "client/inertial/imu_buffer.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

constexpr StampNs kStart = 1'700'000'000'000'000'000;
const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

StampNs at(double ms) {
  return kStart + from_ms(ms);
}

/// At 100 Hz, turning about z at `i` rad/s and pushed along x at `i` m/s^2 at sample i.
ImuBuffer filled(int samples, double keep_seconds = 100) {
  ImuBuffer buffer;
  for (int i = 0; i < samples; ++i)
    buffer.add({{at(10.0 * i), {0, 0, 1.0 * i}, {1.0 * i, 0, 9.81}}, kUp, false}, keep_seconds);
  return buffer;
}

TEST(ImuBuffer, KeepsWhatIsNewEnough) {
  const ImuBuffer buffer = filled(100, 0.5);
  EXPECT_EQ(buffer.newest().raw.stamp_ns, at(990));
  EXPECT_FALSE(buffer.surrounds(at(480)));
  EXPECT_TRUE(buffer.surrounds(at(490)));
  EXPECT_FALSE(buffer.surrounds(at(991)));
  EXPECT_FALSE(ImuBuffer().surrounds(at(0)));
}

TEST(ImuBuffer, TheEntryAtAStampIsTheNewestThatIsNotNewer) {
  const ImuBuffer buffer = filled(10);
  EXPECT_EQ(buffer.at(at(35)).raw.stamp_ns, at(30));
  EXPECT_EQ(buffer.at(at(30)).raw.stamp_ns, at(30));
  EXPECT_EQ(buffer.at(at(-5)).raw.stamp_ns, at(0));
  EXPECT_EQ(buffer.at(at(500)).raw.stamp_ns, at(90));
}

TEST(ImuBuffer, GapsStaleForcesAndOpenEndsAreNotCovered) {
  ImuBuffer buffer = filled(10);
  EXPECT_TRUE(buffer.covers(at(5), at(85)));
  EXPECT_TRUE(buffer.covers(at(5), at(130))) << "near enough to the newest";
  EXPECT_FALSE(buffer.covers(at(5), at(145)));
  EXPECT_FALSE(buffer.covers(at(-5), at(85)));
  EXPECT_FALSE(buffer.covers(at(85), at(85)));
  buffer.add({{at(150), {0, 0, 0}, {0, 0, 9.81}}, kUp, false}, 100);
  EXPECT_FALSE(buffer.covers(at(85), at(150)));
  buffer.add({{at(160), {0, 0, 0}, {0, 0, 9.81}}, kUp, true}, 100);
  EXPECT_FALSE(buffer.covers(at(150), at(165)));
}

TEST(ImuBuffer, SamplesOfASpanLieAtItsEndsAsWell) {
  const auto samples = filled(10).samples(at(25), at(45));
  ASSERT_EQ(samples.size(), 4U);
  const double ms[] = {25, 30, 40, 45}, rates[] = {2.5, 3, 4, 4.5};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(samples[i].stamp_ns, at(ms[i]));
    EXPECT_NEAR(samples[i].angular_velocity_rad_s.z(), rates[i], 1e-9);
  }
  EXPECT_EQ(filled(10).samples(at(85), at(95)).back().stamp_ns, at(95)) << "the newest goes on";
}

TEST(ImuBuffer, ASpanHasNeitherBiasNorGravity) {
  const auto span = filled(10).span(at(25), at(45), {{0, 0, 0.5}, 9.81});
  ASSERT_EQ(span.size(), 4U);
  EXPECT_EQ(span.front().stamp_ns, at(25));
  EXPECT_EQ(span.back().stamp_ns, at(45));
  EXPECT_NEAR(span[1].angular_velocity_rad_s.z(), 2.5, 1e-9);
  EXPECT_NEAR(span[1].acceleration_m_s2.x(), 3, 1e-9);
  EXPECT_NEAR(span[1].acceleration_m_s2.z(), 0, 1e-9);
}

TEST(ImuBuffer, SmoothingTakesSamplesBesideTheSpanInAndKeepsALine) {
  const auto span = filled(100).span(at(450), at(500), {{0, 0, 0}, 9.81}, 2, 5);
  EXPECT_NEAR(span.front().acceleration_m_s2.x(), 45, 1e-6);
  EXPECT_NEAR(span.back().acceleration_m_s2.x(), 50, 1e-6);
}

TEST(ImuBuffer, WhatIsLearnedLaterIsAppliedToAll) {
  ImuBuffer buffer = filled(3);
  buffer.scale_forces(2);
  EXPECT_NEAR(buffer.at(at(0)).raw.specific_force_m_s2.z(), 19.62, 1e-9);
  buffer.take_off(from_ms(5));
  EXPECT_EQ(buffer.newest().raw.stamp_ns, at(15));
  buffer.set_up(Eigen::Vector3d::UnitX(), Eigen::Vector3d::Zero());
  EXPECT_TRUE(buffer.newest().up.isApprox(Eigen::Vector3d::UnitX()));
  const Eigen::Vector3d before = so3_exp({0, 0, 0.01 * 2}) * Eigen::Vector3d::UnitX();
  EXPECT_TRUE(buffer.at(at(5)).up.isApprox(before, 1e-9)) << "it turned by 2 rad/s for 10 ms since";
  buffer.clear();
  EXPECT_TRUE(buffer.empty());
}

}  // namespace
}  // namespace liloc
