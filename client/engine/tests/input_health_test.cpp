#include "client/engine/input_health.hpp"

#include <gmock/gmock.h>

namespace liloc {
namespace {

using testing::HasSubstr;

void note(InputHealth& health, int frames, double residual_m, double strain,
          FrameFault fault = FrameFault::none) {
  for (int i = 0; i < frames; ++i) health.note(fault, residual_m, strain);
}

TEST(InputHealth, FramesInARowWithoutReturnsAreToldUntilOneHasSome) {
  InputHealth health;
  note(health, 14, 0, 1, FrameFault::too_few_points);
  EXPECT_EQ(health.problem(), "");
  note(health, 1, 0, 1, FrameFault::too_few_points);
  EXPECT_THAT(health.problem(), HasSubstr("hardly a return"));
  note(health, 1, 0.005, 1);
  EXPECT_EQ(health.problem(), "");
}

TEST(InputHealth, ResidualsAreJudgedByTheMedianOfEnoughMatches) {
  InputHealth health;
  note(health, 29, 0.020, 1);
  EXPECT_EQ(health.problem(), "") << "too few to say";
  note(health, 1, 0.020, 1);
  EXPECT_THAT(health.problem(), HasSubstr("(20 mm)"));
  note(health, 31, 0.005, 1);
  EXPECT_EQ(health.problem(), "") << "the newest sixty count";
}

TEST(InputHealth, FramesWithoutAMatchSayNothingOfResiduals) {
  InputHealth health;
  note(health, 30, 0.020, 1);
  note(health, 200, 0, 0);
  EXPECT_THAT(health.problem(), HasSubstr("20 mm"));
}

TEST(InputHealth, AStrainThatPersistsIsAContradiction) {
  InputHealth health;
  note(health, 23, 0.005, 3);
  note(health, 37, 0.005, 1);
  EXPECT_FALSE(health.contradicted()) << "right calibrations strain now and then";
  note(health, 37, 0.005, 3);
  EXPECT_TRUE(health.contradicted());
  EXPECT_THAT(health.problem(), HasSubstr("contradict each other (3.0 times"));
  health.forget();
  EXPECT_FALSE(health.contradicted());
  EXPECT_EQ(health.problem(), "");
}

TEST(InputHealth, AContradictionIsNamedBeforeThePoorFitThatItCauses) {
  InputHealth health;
  note(health, 60, 0.020, 3);
  EXPECT_THAT(health.problem(), HasSubstr("contradict"));
}

}  // namespace
}  // namespace liloc
