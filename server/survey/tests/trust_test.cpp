#include "server/survey/trust.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/survey/tests/ceiling.hpp"

namespace liloc::survey {
namespace {

using namespace test;
using testing::HasSubstr;
using testing::IsEmpty;

PoseEvidence sound() {
  return {.overlap = 0.8, .residual_m = 0.01, .conflict = 0.02, .seen = 1000, .sd_m = 0.002, .sd_rad = 0.001};
}

TEST(Trust, WhatNothingSpeaksAgainstIsTrusted) {
  EXPECT_THAT(doubt_of(sound(), {}), IsEmpty());
}

TEST(Trust, EachDoubtNamesItsRemedy) {
  const auto doubt_with = [](double PoseEvidence::*field, double value) {
    PoseEvidence evidence = sound();
    evidence.*field = value;
    return doubt_of(evidence, {});
  };
  EXPECT_THAT(doubt_with(&PoseEvidence::overlap, 0.2), HasSubstr("start nearer"));
  EXPECT_THAT(doubt_with(&PoseEvidence::conflict, 0.3), HasSubstr("wrong place"));
  EXPECT_THAT(doubt_with(&PoseEvidence::residual_m, 0.034), HasSubstr("depth_scale"));
  EXPECT_THAT(doubt_with(&PoseEvidence::sd_m, 0.02), HasSubstr("tilt it"));
  EXPECT_THAT(doubt_with(&PoseEvidence::sd_rad, radians(1)), HasSubstr("tilt it"));
}

TEST(Trust, ALimitThatIsJustMetIsEnough) {
  const TrustOptions limits;
  const PoseEvidence at_limits{.overlap = limits.least_overlap,
                               .residual_m = limits.most_residual_m,
                               .conflict = limits.most_conflict,
                               .seen = 1000,
                               .sd_m = limits.most_sd_m,
                               .sd_rad = limits.most_sd_rad};
  EXPECT_THAT(doubt_of(at_limits, limits), IsEmpty());
}

class EvidenceLaw : public testing::TestWithParam<unsigned> {};

TEST_P(EvidenceLaw, IsBestWhereTheLidarHangs) {
  const auto all = scans(GetParam());
  const Target rest = make_target(rest_of(all, 0), {}, kVoxel_m);
  const Pose T = hung()[0];
  const PoseEvidence here = evidence_of(rest, all[0], T);
  EXPECT_GT(here.seen, 200);
  EXPECT_GT(here.overlap, 0.35);
  EXPECT_LT(here.conflict, 0.05);
  EXPECT_LT(here.sd_m, 0.02);
  const PoseEvidence off = evidence_of(rest, all[0], disturbed(T, GetParam(), 0.3, radians(10)));
  EXPECT_LT(off.overlap, 0.6 * here.overlap);
  EXPECT_GT(off.conflict, here.conflict);
}
INSTANTIATE_TEST_SUITE_P(Seeds, EvidenceLaw, testing::Range(1U, 6U));

}  // namespace
}  // namespace liloc::survey
