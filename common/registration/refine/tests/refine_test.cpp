#include "common/registration/refine/refine.hpp"

#include <gtest/gtest.h>

#include "common/testing/small_motion.hpp"
#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

class RefineLaw : public testing::TestWithParam<unsigned> {};

TEST_P(RefineLaw, ComesBackToTheTruth) {
  const WatchedRoom w = watched_room(GetParam());
  const Alignment a = refine(w.target, w.query, w.T_map_device * small_motion(GetParam(), radians(4), 0.15));
  EXPECT_LT(distance_m(a.T_target_source, w.T_map_device), 0.03);
  EXPECT_LT(degrees(angle_between_rad(a.T_target_source, w.T_map_device)), 0.7);
  EXPECT_GT(a.fitness, 0.3);
}

TEST_P(RefineLaw, MovingTheSensorFrameMovesTheAnswerEqually) {
  const WatchedRoom w = watched_room(GetParam());
  const Pose T_sensor_moved = small_motion(GetParam() + 50, 0.3, 0.5);
  Query moved = w.query;
  for (Cloud* cloud : {&moved.cloud, &moved.medium, &moved.sparse})
    *cloud = transformed(T_sensor_moved.inverse(), *cloud);
  const Pose guess = w.T_map_device * small_motion(GetParam(), radians(2), 0.08);
  const Pose here = refine(w.target, w.query, guess).T_target_source;
  const Pose there = refine(w.target, moved, guess * T_sensor_moved).T_target_source;
  EXPECT_LT(distance_m(there, here * T_sensor_moved), 0.01);
  EXPECT_LT(angle_between_rad(there, here * T_sensor_moved), 0.005);
}

TEST_P(RefineLaw, AnApproachComesNearer) {
  const WatchedRoom w = watched_room(GetParam());
  const Pose guess = w.T_map_device * small_motion(GetParam(), radians(4), 0.15);
  const Pose T = approach(w.target, w.query, guess, 6);
  EXPECT_LT(distance_m(T, w.T_map_device), 0.1);
  EXPECT_EQ(distance_m(approach(w.target, w.query, guess, 0), guess), 0.0);
}

TEST_P(RefineLaw, PointToPointAlsoConverges) {
  const WatchedRoom w = watched_room(GetParam());
  RefineOptions options;
  options.point_to_point = true;
  const Alignment a =
      refine(w.target, w.query, w.T_map_device * small_motion(GetParam(), radians(2), 0.05), options);
  EXPECT_LT(distance_m(a.T_target_source, w.T_map_device), 0.10);
}

INSTANTIATE_TEST_SUITE_P(Seeds, RefineLaw, testing::Range(1U, 9U));

TEST(Refine, APriorHoldsTheDirectionThatAWallDoesNotShow) {
  scene::BoxRoom bare = scene::corridor();
  const Target target = watch(bare, 1);
  const Pose T_map_device = scene::looking({3.0, 1.0, 1.2}, radians(90), 0);
  const Query query = look(bare, T_map_device, 2);
  PosePrior prior;
  prior.T_target_source = T_map_device;
  prior.T_target_source.translation().y() += 0.06;  // seen: the wall pulls this back
  prior.T_target_source.translation().x() += 0.04;  // not seen: stays
  prior.sd_m = 0.05;
  const Pose T = refine(target, query, prior.T_target_source, {}, &prior).T_target_source;
  EXPECT_NEAR(T.translation().y(), T_map_device.translation().y(), 0.02);
  EXPECT_NEAR(T.translation().x(), prior.T_target_source.translation().x(), 0.03);
}

TEST(Refine, NothingToHoldOnToIsAResult) {
  const WatchedRoom w = watched_room(1);
  Pose far = w.T_map_device;
  far.translation().x() += 100;
  const Alignment a = refine(w.target, w.query, far);
  EXPECT_EQ(a.pairs, 0);
  EXPECT_FALSE(a.converged);
  EXPECT_LT(distance_m(a.T_target_source, far), 1e-9);
  EXPECT_EQ(refine(make_target({}, {}, 0.05), w.query, far).pairs, 0);
  EXPECT_EQ(refine(w.target, Query{}, far).pairs, 0);
}

}  // namespace
}  // namespace liloc
