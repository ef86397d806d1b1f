#include "server/localization/tracks.hpp"

#include <gtest/gtest.h>

#include "server/localization/tests/world.hpp"

namespace liloc {
namespace {

Pose at(double x_m, double yaw_deg = 0) {
  return scene::looking({x_m, 0, 1}, radians(yaw_deg), 0);
}

TEST(Tracks, SpotsOfOneViewCountAsOne) {
  const PlaceGate view = TrackOptions{}.view;
  EXPECT_TRUE(weights_of({}, view).empty());
  for (const double weight : weights_of({at(0), at(0), at(0)}, view)) EXPECT_DOUBLE_EQ(weight, 1.0 / 3);
  const auto weights = weights_of({at(0), at(0), at(5), at(5, 90)}, view);
  EXPECT_NEAR(weights[0], 1.0 / 6, 1e-6);
  EXPECT_NEAR(weights[1], 1.0 / 6, 1e-6);
  EXPECT_NEAR(weights[2], 1.0 / 3, 1e-6);
  EXPECT_NEAR(weights[3], 1.0 / 3, 1e-6) << "elsewhere or looking elsewhere alike";
}

class TracksLaw : public testing::TestWithParam<unsigned> {
 protected:
  std::shared_ptr<const Spot> spot(int k) {
    world.watch(k);
    const auto room = world.cloud->nearest(kT0 + k * kStep);
    return *Spot::create(world.request(k, world.truth(k)), *room, {});
  }
  World world{GetParam()};
};

TEST_P(TracksLaw, SearchesThatAgreeThroughOdometryAreCountedAndSurfacesGather) {
  Tracks tracks;
  double bits = 0;
  for (int k = 0; k < 4; ++k) {
    const auto asked = spot(k);
    tracks.add(asked, {refine_and_judge(asked->problem(), world.truth(k))});
    const auto evidence = tracks.evidence(0.01);
    ASSERT_EQ(tracks.best_first().size(), 1U);
    EXPECT_EQ(evidence.front().agreeing, k + 1);
    EXPECT_EQ(evidence.front().searches, k + 1);
    EXPECT_GE(evidence.front().bits, bits);
    bits = evidence.front().bits;
    EXPECT_TRUE(near(tracks.best_first().front().T_map_odom * asked->T_odom_sensor(), world.truth(k)));
  }
  EXPECT_GT(bits, 5);
}

TEST_P(TracksLaw, ASearchThatComesElsewhereIsARivalAndNoAgreement) {
  Tracks tracks;
  for (int k = 0; k < 3; ++k) {
    const auto asked = spot(k);
    tracks.add(asked, {refine_and_judge(asked->problem(), world.truth(k))});
  }
  const auto asked = spot(3);
  const Pose twin = scene::looking({4.0, 3.4, 1.2}, 2.5, 0.2);
  Hypothesis wrong = refine_and_judge(asked->problem(), twin);
  wrong.alignment.T_target_source = twin;
  wrong.judgement.agree = 0.3;
  tracks.add(asked, {wrong});
  const auto evidence = tracks.evidence(0.01);
  EXPECT_EQ(evidence.front().agreeing, 3);
  EXPECT_EQ(evidence.front().searches, 4);
  EXPECT_TRUE(near(tracks.best_first().front().T_map_odom * asked->T_odom_sensor(), world.truth(3)));
  EXPECT_GE(evidence.size(), 2U);
}

INSTANTIATE_TEST_SUITE_P(Seeds, TracksLaw, testing::Range(1U, 4U));

}  // namespace
}  // namespace liloc
