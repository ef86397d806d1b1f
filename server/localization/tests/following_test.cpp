#include "server/localization/following.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

const LookTerms kClean = terms_of({0.7, 0.001, 1.0, 0.0, 0.6, 0}, true);

Followed believed() {
  PoseEstimate estimate;
  estimate.covariance = 1e-5 * Matrix6d::Identity();
  return begun(estimate, Pose::Identity(), log_odds_of_risk(1e-3), kClean);
}

TEST(Following, CleanLooksMakeSurerUpToWhatMayBreakUnseen) {
  Followed followed = believed();
  for (int i = 0; i < 50; ++i) {
    const double before = followed.log_odds;
    note_look(kClean, true, 1.0, &followed);
    EXPECT_GE(followed.log_odds, before);
  }
  EXPECT_LT(confidence_of(followed), 1 - 1e-5);
  EXPECT_GT(confidence_of(followed), 1 - 1e-3);
}

TEST(Following, WhatIsNotNewAddsLess) {
  Followed still = believed(), moving = believed();
  still.log_odds = moving.log_odds = 2;
  note_look(kClean, true, 0.0, &still);
  note_look(kClean, true, 1.0, &moving);
  EXPECT_GT(still.log_odds, 2);
  EXPECT_GT(moving.log_odds, still.log_odds);
}

TEST(Following, ALookThatLeavesThePlaceIsNotVerifiedAndTwoOrThreeUndoTheBelief) {
  Followed followed = believed();
  for (int i = 0; i < 20; ++i) note_look(kClean, true, 1.0, &followed);
  const LookTerms elsewhere = terms_of({0.3, 0.10, 0.6, 0.4, 0.6, 0}, false);
  note_look(elsewhere, false, 0.1, &followed);
  EXPECT_LT(confidence_of(followed), 1 - 1e-3);
  note_look(elsewhere, false, 0.1, &followed);
  EXPECT_LT(followed.log_odds, 0);
}

TEST(Following, ASensorThatIsAlwaysContradictedABitIsNoNews) {
  const LookTerms noisy = terms_of({0.5, 0.03, 0.98, 0.02, 0.6, 0}, true);
  Followed followed = believed();
  followed.usual = noisy;
  for (int i = 0; i < 20; ++i) note_look(noisy, true, 0.0, &followed);
  EXPECT_GT(confidence_of(followed), 1 - 1e-3);
}

TEST(Following, WhereTheCeilingDoesNotLookTheBeliefWearsOffSlowly) {
  const LookTerms blind = terms_of({0.0, 0.0, 0.0, 0.0, 0.0, 0}, false);
  Followed followed = believed();
  note_look(blind, true, 1.0, &followed);
  const double after_one = followed.log_odds;
  EXPECT_NEAR(after_one, believed().log_odds, 0.3);
  for (int i = 0; i < 100; ++i) note_look(blind, true, 1.0, &followed);
  EXPECT_LT(followed.log_odds, after_one - 1);
}

TEST(Following, APoseThatIsNotKnownToCentimetresIsNotVerified) {
  Followed followed = believed();
  followed.estimate.covariance = 0.04 * Matrix6d::Identity();
  EXPECT_LT(confidence_of(followed), 0.9);
}

TEST(Following, ASearchThatComesElsewhereSpeaksAgainstIt) {
  Followed followed = believed();
  note_search(3, true, &followed);
  EXPECT_NEAR(followed.log_odds, believed().log_odds - 3, 1e-12);
  note_search(-2, true, &followed);
  EXPECT_NEAR(followed.log_odds, believed().log_odds - 3, 1e-12) << "a weak find is no news";
  note_search(8, false, &followed);
  EXPECT_NEAR(followed.log_odds, 8, 1e-12);
}

TEST(Unwatched, IsLessSureOfThePlaceAndOfThePose) {
  PoseEstimate estimate;
  estimate.covariance = 1e-6 * Matrix6d::Identity();
  const Followed before = begun(estimate, Pose::Identity(), 7, {});
  const Followed after = unwatched(before, 10, radians(0.2), 0.008);
  EXPECT_LT(after.log_odds, before.log_odds);
  EXPECT_GT(probability_of(after.log_odds), 0.997) << "a break of the odometry is rare";
  EXPECT_NEAR(after.estimate.sd_m(), 0.08, 0.002);
  EXPECT_NEAR(degrees(after.estimate.sd_rad()), 2, 0.1);
  EXPECT_TRUE(after.estimate.T_map_sensor.isApprox(before.estimate.T_map_sensor));
  EXPECT_LT(unwatched(before, 100, 0, 0).log_odds, after.log_odds);
}

}  // namespace
}  // namespace liloc
