#include "server/localization/belief.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "common/testing/box_room.hpp"

namespace liloc {
namespace {

const BeliefOptions kOptions;

Pose at(double x_m, double yaw_deg = 0) {
  return scene::looking({x_m, 0, 1}, radians(yaw_deg), 0);
}

TEST(Belief, MoreThatAgreesSpeaksForAPlaceAndMoreThatContradictsAgainstIt) {
  const Judgement half{0.5, 0.0, 1.0, 0.0, 0.5, 0}, most{0.9, 0.0, 1.0, 0.0, 0.5, 0};
  Judgement seen_through = most, looks_through = most;
  seen_through.conflict = 0.02;
  looks_through.map_conflict = 0.04;  // of the half that is in view
  EXPECT_GT(evidence_of(most, true, kOptions), evidence_of(half, true, kOptions));
  EXPECT_LT(evidence_of(seen_through, true, kOptions), evidence_of(most, true, kOptions));
  EXPECT_DOUBLE_EQ(evidence_of(looks_through, true, kOptions), evidence_of(seen_through, true, kOptions));
  EXPECT_LT(evidence_of(most, false, kOptions), evidence_of(half, true, kOptions));
}

TEST(Belief, WhatContradictsMoreThanEverTheRightPlaceWeighsBeyondTheLogarithm) {
  const auto contradicted_by = [](double conflict) {
    return evidence_of({0.9, conflict, 1.0, 0.0, 0.5, 0}, true, kOptions);
  };
  const double most = kOptions.much_conflict;
  EXPECT_NEAR(contradicted_by(most / 4) - contradicted_by(most / 2), kOptions.conflict * std::log(2.0), 0.05);
  EXPECT_NEAR(contradicted_by(most) - contradicted_by(2 * most),
              kOptions.conflict * std::log(2.0) + kOptions.beyond * most, 0.05);
}

TEST(Belief, SpotsOfOneViewCountAsOne) {
  EXPECT_TRUE(weights_of({}, kOptions).empty());
  const auto same = weights_of({at(0), at(0), at(0)}, kOptions);
  for (const double weight : same) EXPECT_DOUBLE_EQ(weight, 1.0 / 3);
  const auto weights = weights_of({at(0), at(0), at(5), at(5, 90)}, kOptions);
  EXPECT_NEAR(weights[0], 1.0 / 6, 1e-6);
  EXPECT_NEAR(weights[1], 1.0 / 6, 1e-6);
  EXPECT_NEAR(weights[2], 1.0 / 3, 1e-6);
  EXPECT_NEAR(weights[3], 1.0 / 3, 1e-6) << "elsewhere or looking elsewhere alike";
}

TEST(Belief, OddsAreThoseOfTheLogit) {
  BeliefOptions options;
  options.elsewhere = 1;
  const std::vector<double> evidence{3, 0.5, 2};
  const double all = std::exp(3.0) + std::exp(0.5) + std::exp(2.0) + std::exp(1.0);
  for (std::size_t i = 0; i < evidence.size(); ++i) {
    const double p = std::exp(evidence[i]) / all;
    EXPECT_NEAR(log_odds_of(i, evidence, options), std::log(p / (1 - p)), 1e-12);
  }
}

TEST(Belief, ALonePlaceIsHeldAgainstElsewhere) {
  EXPECT_DOUBLE_EQ(log_odds_of(0, {2.0}, kOptions), 2.0 - kOptions.elsewhere);
}

TEST(Belief, WhereTheCeilingDoesNotLookIsElsewhereAndNoPlaceOfItsOwn) {
  EXPECT_FALSE(is_somewhere({0.02, 0.0, 0.0, 0.0, 0.0, 0}, kOptions));
  EXPECT_TRUE(is_somewhere({0.2, 0.0, 1.0, 0.0, 0.1, 0}, kOptions));
}

TEST(Belief, ARivalThatIsAsGoodLeavesNothingSure) {
  const double clean = evidence_of({0.9, 0.0, 1.0, 0.0, 0.5, 0}, true, kOptions);
  EXPECT_LT(log_odds_of(0, {clean, clean}, kOptions), 0);
}

}  // namespace
}  // namespace liloc
