#include "server/localization/equality.hpp"

#include <gtest/gtest.h>

#include <random>

namespace liloc {
namespace {

Pose random_pose(std::mt19937& rng, double angle_rad, double shift_m) {
  std::normal_distribution<double> unit(0, 1);
  Vector6d a;
  for (int i = 0; i < 6; ++i) a[i] = unit(rng) * (i < 3 ? angle_rad : shift_m);
  return increment(a);
}

/// Three spots of a device that moves; odometry lies anywhere in the map.
std::array<SpotPose, 3> chain(unsigned seed) {
  std::mt19937 rng(seed);
  const Pose T_map_odom = random_pose(rng, 1.0, 3.0);
  Pose T_odom_sensor = random_pose(rng, 1.0, 3.0);
  std::array<SpotPose, 3> spots;
  for (SpotPose& spot : spots) {
    T_odom_sensor = T_odom_sensor * random_pose(rng, 0.2, 0.5);
    spot = {T_map_odom * T_odom_sensor, T_odom_sensor};
  }
  return spots;
}

class EqualityLaw : public testing::TestWithParam<unsigned> {};

TEST_P(EqualityLaw, RightSpotsPassAllChecks) {
  const Verification v = verify(chain(GetParam()));
  EXPECT_EQ(v.verdict, Verdict::all_agree);
  EXPECT_EQ(v.checks, (std::array<bool, 3>{true, true, true}));
  EXPECT_FALSE(v.wrong);
}

TEST_P(EqualityLaw, AnyOneWrongSpotIsFoundAndCorrected) {
  for (std::size_t wrong = 0; wrong < 3; ++wrong) {
    auto spots = chain(GetParam());
    const Pose truth = spots[wrong].T_map_sensor;
    spots[wrong].T_map_sensor.translation().x() += 1.5;
    const Verification v = verify(spots);
    ASSERT_EQ(v.verdict, Verdict::one_corrected);
    EXPECT_EQ(v.wrong, wrong);
    EXPECT_LT(distance_m(v.T_map_sensor[wrong], truth), 1e-9);
  }
}

TEST_P(EqualityLaw, TwoWrongSpotsGiveNoAnswer) {
  auto spots = chain(GetParam());
  spots[0].T_map_sensor.translation().x() += 1.5;
  spots[2].T_map_sensor.translation().y() -= 2.0;
  EXPECT_EQ(verify(spots).verdict, Verdict::none);
}

INSTANTIATE_TEST_SUITE_P(Seeds, EqualityLaw, testing::Range(1U, 17U));

}  // namespace
}  // namespace liloc
