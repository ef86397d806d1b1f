#include "server/localization/advice.hpp"

#include <gmock/gmock.h>

#include "common/testing/box_room.hpp"

namespace liloc {
namespace {

using testing::HasSubstr;

const Judgement kClean{0.7, 0.0, 1.0, 0.0, 0.6, 0};

Evidence one_place(double searches, const Judgement& judgement = kClean) {
  Evidence e;
  e.places = {{searches, searches, terms_of(judgement, true), 60, 0.005}};
  e.T_map_sensors = {Pose::Identity()};
  return e;
}

TEST(Advice, NothingThatFitsAsksToMoveOn) {
  EXPECT_EQ(advice_for(Evidence{}, {}).advice, Advice::move_on);
}

TEST(Advice, WhatTheCeilingDoesNotSeeAsksToTurnAndInTheEndForCoverage) {
  const Judgement blind{0.04, 0.0, 1.0, 0.0, 0.1, 0};
  EXPECT_EQ(advice_for(one_place(1, blind), blind).advice, Advice::turn_around);
  EXPECT_EQ(advice_for(one_place(5, blind), blind).advice, Advice::more_coverage);
  EXPECT_THAT(advice_for(one_place(1, blind), blind).text, HasSubstr("4 %"));
  EXPECT_EQ(advice_for(one_place(5, kClean), blind).advice, Advice::turn_around) << "other views saw more";
}

TEST(Advice, ATwinIsNamed) {
  Evidence e = one_place(4);
  e.places.push_back(e.places.front());
  e.T_map_sensors.push_back(scene::looking({3, 4, 0}, 0));
  const Advised advised = advice_for(e, kClean);
  EXPECT_EQ(advised.advice, Advice::twin);
  EXPECT_THAT(advised.text, HasSubstr("5.0 m"));
}

TEST(Advice, SomebodyCloseByAndBareWallsAndFewSpotsAreTold) {
  Judgement blocked = kClean;
  blocked.conflict = 0.05;
  EXPECT_EQ(advice_for(one_place(4), blocked).advice, Advice::clear_view);
  Evidence loose = one_place(4);
  loose.places.front().sd_m = 0.2;
  EXPECT_EQ(advice_for(loose, kClean).advice, Advice::turn_around);
  EXPECT_EQ(advice_for(one_place(1), kClean).advice, Advice::wait);
}

TEST(Advice, AFollowedPoseInDoubtIsToldByWhatTheSpotShows) {
  Followed followed;
  followed.estimate.covariance = 1e-5 * Matrix6d::Identity();
  EXPECT_EQ(advice_for(followed, kClean).advice, Advice::wait);
  EXPECT_EQ(advice_for(followed, {0.04, 0.0, 1.0, 0.0, 0.1, 0}).advice, Advice::turn_around);
  EXPECT_EQ(advice_for(followed, {0.7, 0.05, 1.0, 0.0, 0.6, 0}).advice, Advice::clear_view);
  followed.estimate.covariance = 0.04 * Matrix6d::Identity();
  EXPECT_EQ(advice_for(followed, kClean).advice, Advice::turn_around);
}

}  // namespace
}  // namespace liloc
