#include "server/localization/confidence.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "common/testing/box_room.hpp"

namespace liloc {
namespace {

/// A place to which so many of five searches came, seen well and contradicted by next to nothing.
PlaceEvidence seen_well(double agreeing = 5) {
  return {agreeing, 5, terms_of({0.7, 0.0, 1.0, 0.0, 0.6, 0}, true), 120, 0.005};
}

PlaceEvidence with_looks(const Judgement& judgement, bool fits = true) {
  PlaceEvidence place = seen_well();
  place.looks = terms_of(judgement, fits);
  return place;
}

TEST(Confidence, MoreThatAgreesSpeaksForAPlaceAndMoreThatContradictsAgainstIt) {
  const Judgement half{0.5, 0.0, 1.0, 0.0, 0.5, 0}, most{0.9, 0.0, 1.0, 0.0, 0.5, 0};
  Judgement seen_through = most, looks_through = most;
  seen_through.conflict = 0.02;
  looks_through.map_conflict = 0.04;  // of the half that is in view
  EXPECT_GT(log_odds_of({with_looks(most)}), log_odds_of({with_looks(half)}));
  EXPECT_LT(log_odds_of({with_looks(seen_through)}), log_odds_of({with_looks(most)}));
  EXPECT_DOUBLE_EQ(terms_of(looks_through, true).contradiction, terms_of(seen_through, true).contradiction);
}

TEST(Confidence, SearchesThatAgreeAddUp) {
  for (int n = 1; n <= 5; ++n)
    EXPECT_GT(log_odds_of({seen_well(n)}), log_odds_of({seen_well(n - 1)})) << n << " of five";
}

TEST(Confidence, DistinctSurfacesAndAFirmPoseCount) {
  PlaceEvidence few = seen_well(), loose = seen_well();
  few.bits = 10;
  loose.sd_m = 0.2;
  EXPECT_LT(log_odds_of({few}), log_odds_of({seen_well()}));
  EXPECT_LT(log_odds_of({loose}), log_odds_of({seen_well()}));
}

TEST(Confidence, ARivalThatIsAsGoodLeavesNothingSure) {
  EXPECT_LT(log_odds_of({seen_well(), seen_well()}), 2.0);
  EXPECT_LT(probability_of(log_odds_of({seen_well(), seen_well()})), 0.9);
}

TEST(Confidence, ARoomThatRepeatsItselfMayHaveATwinWhereTheCeilingDoesNotLook) {
  PlaceEvidence contradicted = seen_well(0);  // no rival, but it shows how alike the room is to itself
  contradicted.looks = terms_of({0.6, 0.05, 0.9, 0.1, 0.6, 0}, false);
  EXPECT_LT(log_odds_of({seen_well(), contradicted}), log_odds_of({seen_well()}) - 1);
}

TEST(Confidence, WhereTheCeilingHardlyLooksIsNoRival) {
  PlaceEvidence elsewhere;
  elsewhere.looks = terms_of({0.01, 0, 0, 0, 0, 0}, false);
  elsewhere.bits = 2;
  EXPECT_NEAR(log_odds_of({seen_well(), elsewhere}), log_odds_of({seen_well()}), 0.2);
}

TEST(Confidence, ProbabilitiesAndOddsAreInverse) {
  for (const double risk : {0.5, 0.1, 1e-3, 1e-6})
    EXPECT_NEAR(1 - probability_of(log_odds_of_risk(risk)), risk, 1e-9 + 1e-6 * risk);
}

TEST(Confidence, APoseThatMayBeFarOffIsNotWithinItsLimits) {
  PoseEstimate estimate;
  estimate.covariance = 1e-6 * Matrix6d::Identity();
  EXPECT_GT(precision_of(estimate), 0.9999);
  double before = 1;
  for (const double sd_m : {0.05, 0.1, 0.2, 0.5}) {
    estimate.covariance.bottomRightCorner<3, 3>() = sd_m * sd_m * Eigen::Matrix3d::Identity();
    EXPECT_LT(precision_of(estimate), before);
    before = precision_of(estimate);
  }
  EXPECT_LT(before, 0.5);
}

}  // namespace
}  // namespace liloc
