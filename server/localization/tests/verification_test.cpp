#include "server/localization/verification.hpp"

#include <gtest/gtest.h>

#include <tuple>

namespace liloc {
namespace {

const VerifyOptions kOptions;

/// A place that all agrees with; device and ceiling alike.
Hypothesis clean_at(double x_m) {
  Hypothesis h;
  h.alignment.T_target_source.translation().x() = x_m;
  h.alignment.pair_share = 0.8;
  h.judgement = {0.8, 0.0, 1.0, 0.0, 0.6, 1.4};
  return h;
}

PoseEstimate sure_at(double x_m) {
  PoseEstimate estimate;
  estimate.T_map_sensor.translation().x() = x_m;
  estimate.covariance = 1e-6 * Matrix6d::Identity();
  return estimate;
}

/// Spots that agree on one place.
Evidence agreeing_spots() {
  Evidence e;
  e.own = e.best = clean_at(1);
  e.own_estimate = e.best_estimate = sure_at(1);
  e.margin = 1;
  e.stayed = true;
  e.spots = 5;
  e.log_odds = e.own_log_odds = kOptions.log_odds_few;
  return e;
}

TEST(Verification, SpotsThatAgreeDecideAndSoMayOne) {
  EXPECT_TRUE(confirmed(agreeing_spots(), kOptions));
  EXPECT_TRUE(conclusive(agreeing_spots(), kOptions));
}

TEST(Verification, OddsDecideBeforeAPlaceIsBelievedAndNotAfterwards) {
  Evidence e = agreeing_spots();
  e.log_odds = kOptions.log_odds - 0.01;
  EXPECT_FALSE(confirmed(e, kOptions));
  EXPECT_TRUE(holds(e, kOptions));
  EXPECT_TRUE(conclusive(e, kOptions)) << "a spot alone is asked by its own odds";
  e.own_log_odds = kOptions.log_odds;
  EXPECT_FALSE(conclusive(e, kOptions));
}

TEST(Verification, TheLessTheCeilingSeesOfAPlaceTheSurerOneMustBe) {
  Evidence e = agreeing_spots();
  e.log_odds = kOptions.log_odds;
  for (const double agree : {0.8, 0.5, 0.45, 0.4}) {
    e.best->judgement.agree = agree;
    EXPECT_EQ(led(e, kOptions), agree >= kOptions.much_agrees) << agree;
  }
  e.log_odds += kOptions.twin_odds * (kOptions.much_agrees - 0.4);
  EXPECT_TRUE(led(e, kOptions));
  e.best.reset();
  EXPECT_FALSE(led(e, kOptions)) << "nothing was found";
}

TEST(Verification, FewSpotsMustBeSurer) {
  Evidence e = agreeing_spots();
  e.log_odds = kOptions.log_odds;
  for (const std::size_t spots : {1, 2, 3, 5}) {
    e.spots = spots;
    EXPECT_EQ(led(e, kOptions), spots >= 3) << spots;
  }
}

TEST(Verification, APlaceSeenLittleMayBeFollowedButNotBelievedAtFirst) {
  Evidence e = agreeing_spots();
  e.own->judgement.agree = e.best->judgement.agree = kOptions.first_agree - 0.01;
  e.own->alignment.pair_share = e.best->alignment.pair_share = e.own->judgement.agree;
  EXPECT_FALSE(confirmed(e, kOptions));
  EXPECT_FALSE(conclusive(e, kOptions));
  EXPECT_TRUE(holds(e, kOptions));
}

TEST(Verification, TheNewestSpotMustBearThePlaceOut) {
  Evidence e = agreeing_spots();
  e.stayed = false;
  EXPECT_FALSE(confirmed(e, kOptions));
  e = agreeing_spots();
  e.best->judgement.conflict = 0.03;
  EXPECT_FALSE(confirmed(e, kOptions));
  e.own = e.best;
  EXPECT_FALSE(conclusive(e, kOptions));
}

TEST(Verification, FollowingBearsMoreContradictionThanBelievingAtFirst) {
  for (const auto& [conflict, map_agree, first, followed] :
       {std::tuple{0.01, 0.99, true, true}, std::tuple{0.03, 0.99, false, true},
        std::tuple{0.01, 0.94, false, true}, std::tuple{0.06, 0.99, false, false},
        std::tuple{0.01, 0.91, false, false}}) {
    Evidence e = agreeing_spots();
    e.best->judgement.conflict = conflict;
    e.best->judgement.map_agree = map_agree;
    EXPECT_EQ(confirmed(e, kOptions), first) << conflict << ' ' << map_agree;
    EXPECT_EQ(holds(e, kOptions), followed) << conflict << ' ' << map_agree;
  }
}

TEST(Verification, WhatIsNotKnownToCentimetresIsNotVerified) {
  Evidence e = agreeing_spots();
  e.own_estimate.covariance = e.best_estimate.covariance = Matrix6d::Identity();
  EXPECT_FALSE(confirmed(e, kOptions));
  EXPECT_FALSE(conclusive(e, kOptions));
}

TEST(Verification, SeenLittleIsNoContradiction) {
  Evidence e = agreeing_spots();
  EXPECT_FALSE(contradicted(e, kOptions));
  e.best->judgement = {0.02, 0.0, 0.0, 0.0, 0.0, 0.02};  // nothing in view of either side
  EXPECT_FALSE(contradicted(e, kOptions));
  EXPECT_FALSE(follows(e, kOptions));
  e.best->judgement = {0.6, 0.05, 1.0, 0.0, 0.5, 0.0};
  EXPECT_TRUE(contradicted(e, kOptions));
  e.best->judgement = {0.6, 0.0, 0.9, 0.1, 0.5, 0.0};
  EXPECT_TRUE(contradicted(e, kOptions));
  e.best.reset();
  EXPECT_FALSE(contradicted(e, kOptions));
}

TEST(Verification, WhatConflictsWithTheDeviceDoesNotHold) {
  Evidence e = agreeing_spots();
  EXPECT_TRUE(holds(e, kOptions));
  e.best->judgement.conflict = 0.05;
  EXPECT_FALSE(holds(e, kOptions));
  EXPECT_TRUE(follows(e, kOptions));
}

}  // namespace
}  // namespace liloc
