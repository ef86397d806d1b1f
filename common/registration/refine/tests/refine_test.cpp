#include "common/registration/refine/refine.hpp"

#include <gtest/gtest.h>

#include <random>

#include "common/registration/refine/plane_pairs.hpp"
#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

Pose small_motion(unsigned seed, double angle_rad, double shift_m) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> unit(0, 1);
  Vector6d a;
  for (int i = 0; i < 6; ++i) a[i] = unit(rng);
  a.head<3>() *= angle_rad / a.head<3>().norm();
  a.tail<3>() *= shift_m / a.tail<3>().norm();
  return increment(a);
}

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

TEST_P(RefineLaw, PairsEightAtATimeAreThePairsOneByOne) {
  const WatchedRoom w = watched_room(GetParam());
  const Side side{w.target->cloud, w.target->nearest, w.query.medium};
  const Pose T = w.T_map_device * small_motion(GetParam(), radians(2), 0.05);
  PlanePairs pairs(side);
  for (const double distance_m : {0.2, 0.06}) {
    NormalEquations expected;
    for_each_pair(side, T, distance_m, 0.5,
                  [&](std::size_t, const Eigen::Vector3f& arm, const Eigen::Vector3f& normal,
                      const Eigen::Vector3f& offset, double weight) {
                    const Vector6d jacobian = jacobian_of(arm, normal);
                    const auto residual = static_cast<double>(normal.dot(offset));
                    expected.H += weight * jacobian * jacobian.transpose();
                    expected.g += weight * residual * jacobian;
                    expected.squared += weight * residual * residual;
                    expected.weight += weight;
                    ++expected.pairs;
                  });
    const NormalEquations got = pairs.at(T, distance_m, 0.5);
    ASSERT_GT(expected.pairs, 50);
    EXPECT_LE(std::abs(got.pairs - expected.pairs), 2) << "of those at the very limit";
    EXPECT_LT((got.H - expected.H).norm(), 2e-3 * expected.H.norm());
    EXPECT_LT((got.g - expected.g).norm(), 2e-3 * expected.H.norm() * distance_m);
    EXPECT_NEAR(got.squared, expected.squared, 5e-3 * expected.squared);
    EXPECT_NEAR(got.weight, expected.weight, 2e-3 * expected.weight);
  }
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
