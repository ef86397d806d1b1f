#include "common/registration/spot/polish.hpp"

#include <gtest/gtest.h>

#include <random>

#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

/// A motion of just these lengths, in a direction and about an axis by the seed.
Pose random_motion(unsigned seed, double shift_m, double turn_rad) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> unit(0, 1);
  const auto direction = [&] { return Eigen::Vector3d(unit(rng), unit(rng), unit(rng)).normalized(); };
  Pose T = Pose::Identity();
  T.linear() = so3_exp(turn_rad * direction());
  T.translation() = shift_m * direction();
  return T;
}

class PolishLaw : public testing::TestWithParam<unsigned> {};

TEST_P(PolishLaw, EndsAtTheDeviceAndNeverWorseThanRefiningAlone) {
  const WatchedRoom w = watched_room(GetParam());
  const SpotProblem problem = w.problem();
  const Pose guess = w.T_map_device * random_motion(GetParam(), 0.3, radians(6));
  const Hypothesis refined = refine_and_judge(problem, guess);
  const Hypothesis polished = polish(problem, guess, refined);
  EXPECT_GE(polished.judgement.score, refined.judgement.score);
  EXPECT_LT(distance_m(polished.T_map_sensor(), w.T_map_device), 0.05);
  EXPECT_LT(angle_between_rad(polished.T_map_sensor(), w.T_map_device), radians(1.0));
}

TEST_P(PolishLaw, APoseThatNothingContradictsIsClean) {
  const WatchedRoom w = watched_room(GetParam());
  Hypothesis h = refine_and_judge(w.problem(), w.T_map_device);
  EXPECT_GT(h.judgement.overlap(), 0.97);
  const Hypothesis off = refine_and_judge(w.problem(), w.T_map_device * random_motion(GetParam(), 2.0, 1.0));
  EXPECT_TRUE(!is_clean(off) || distance_m(off.T_map_sensor(), w.T_map_device) < 0.3);
  h.judgement = {1.0, 0.0, 1.0, 0.0, 0.5, 1.5};
  EXPECT_TRUE(is_clean(h));
  h.judgement.conflict = 0.01;
  EXPECT_FALSE(is_clean(h));
}

/// Along a corridor nothing tells where the device is: what is held stays there, and is put right across.
TEST_P(PolishLaw, WhatSurfacesDoNotHoldTheHoldDoes) {
  const scene::BoxRoom room = scene::corridor();
  const Camera camera = scene::small_camera();
  const Pose T_map_sensor = scene::looking({3.0, 1.0, 1.2}, radians(60) + 0.1 * GetParam(), radians(20));
  const auto cloud = depth_to_cloud(scene::render(room, T_map_sensor, camera, 1, 0.005, GetParam()), camera);
  const Query query = make_query(*cloud, nullptr, {});
  const Target target = make_target(transformed(T_map_sensor, query.cloud), {}, 0.05);
  Pose guess = T_map_sensor;
  guess.translation() += Eigen::Vector3d(0.15, 0.05, 0.0);
  RefineOptions held;
  held.hold = 0.05;
  const Pose T = refine(target, query, guess, held).T_target_source;
  EXPECT_LT(std::abs(T.translation().y() - T_map_sensor.translation().y()), 0.02);
  const double free_m =
      std::abs(refine(target, query, guess).T_target_source.translation().x() - guess.translation().x());
  EXPECT_LE(std::abs(T.translation().x() - guess.translation().x()), free_m + 0.001);
}

INSTANTIATE_TEST_SUITE_P(Seeds, PolishLaw, testing::Range(1U, 9U));

}  // namespace
}  // namespace liloc
