#include "server/localization/verification.hpp"

#include <gtest/gtest.h>

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

/// Three spots that agree on one place.
Evidence three_spots() {
  Evidence e;
  e.own = e.best = clean_at(1);
  e.own_estimate = e.best_estimate = sure_at(1);
  e.margin = 1;
  e.stayed = true;
  e.supports = 3;
  e.lead_per_spot = 1;
  e.chain = Reason::confirmed;
  return e;
}

TEST(Verification, ThreeSpotsThatAgreeDecide) {
  EXPECT_EQ(confirmed(three_spots(), kOptions), Reason::confirmed);
  EXPECT_TRUE(conclusive(three_spots(), kOptions));
  EXPECT_TRUE(seconded(three_spots(), kOptions));
}

TEST(Verification, NoLeadCountsOverAPlaceThatAsManySpotsFit) {
  Evidence e = three_spots();
  for (const int rival : {2, 3}) {
    e.rival_supports = rival;
    EXPECT_FALSE(led(e, kOptions)) << rival;
    EXPECT_FALSE(confirmed(e, kOptions)) << rival;
    EXPECT_FALSE(seconded(e, kOptions)) << rival;
  }
  e.rival_supports = 1;
  EXPECT_TRUE(led(e, kOptions));
  e.supports = 5;
  e.rival_supports = 3;
  EXPECT_TRUE(led(e, kOptions));
}

TEST(Verification, ASmallLeadOrAPlaceSeenLittleDecidesNothing) {
  Evidence e = three_spots();
  e.lead_per_spot = kOptions.lead_per_spot - 0.01;
  EXPECT_FALSE(confirmed(e, kOptions));
  e = three_spots();
  e.best->judgement.agree = kOptions.confirmed_agree - 0.01;
  EXPECT_FALSE(confirmed(e, kOptions));
  EXPECT_TRUE(holds(e, kOptions)) << "once believed it may go on";
}

TEST(Verification, ASpotThatFindsAnotherPlaceIsNotSeconded) {
  Evidence e = three_spots();
  e.own = clean_at(4);
  EXPECT_FALSE(seconded(e, kOptions));
  e.own.reset();
  EXPECT_FALSE(seconded(e, kOptions));
}

TEST(Verification, SeenLittleIsNoContradiction) {
  Evidence e = three_spots();
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
  Evidence e = three_spots();
  EXPECT_TRUE(holds(e, kOptions));
  e.best->judgement.conflict = 0.03;
  EXPECT_FALSE(holds(e, kOptions));
  EXPECT_TRUE(follows(e, kOptions));
}

}  // namespace
}  // namespace liloc
