#include "common/registration/scan/scan_match.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "common/geometry/depth.hpp"
#include "common/testing/box_room.hpp"

namespace liloc {
namespace {

using scene::corridor;
using scene::furnished_room;
using scene::looking;
using scene::render;
using scene::small_camera;

std::vector<Surfel> surfels_of(const scene::BoxRoom& room, const Pose& T, StampNs stamp, double noise_m) {
  return extract_surfels(*depth_to_cloud(render(room, T, small_camera(), stamp, noise_m), small_camera()),
                         Eigen::Vector3f::Zero());
}

Pose disturbed(const Pose& T, unsigned seed, double rad, double m) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> unit;
  const Eigen::Vector3d axis = Eigen::Vector3d(unit(rng), unit(rng), unit(rng)).normalized();
  const Eigen::Vector3d way = Eigen::Vector3d(unit(rng), unit(rng), unit(rng)).normalized();
  Pose moved = T;
  moved.linear() = T.linear() * so3_exp(rad * axis);
  moved.translation() += m * way;
  return moved;
}

/// Stands still in view for so many frames, and has made a step in the next.
struct Person {
  scene::Box stood;
  int frames;
  Eigen::Vector3d step;
};

/// How far off the answer is where the guess, sure or not, is right.
double error_m(scene::BoxRoom room, const Person& person, const MotionGuess& truth, StampNs stamp_ns) {
  const Pose& T = truth.T_map_sensor;
  LocalMap map;
  room.furniture.push_back(person.stood);
  for (int i = 0; i < person.frames; ++i)
    map.insert(T, surfels_of(room, T, from_ms(300.0 * i), 0.004), from_ms(300.0 * i));
  room.furniture.back() = {person.stood.low + person.step, person.stood.high + person.step};
  const auto found = match_scan(map, surfels_of(room, T, stamp_ns, 0.004), truth, stamp_ns);
  return found ? distance_m(found->T_map_sensor, T) : std::numeric_limits<double>::infinity();
}

class ScanMatchLaw : public testing::TestWithParam<unsigned> {};

TEST_P(ScanMatchLaw, FindsTheWayBackFromADisturbedGuess) {
  const auto room = furnished_room(GetParam());
  const Pose T_first = looking({2.6, 2.2, 1.2}, 0.7 * GetParam(), 0.2);
  LocalMap map;
  map.insert(T_first, surfels_of(room, T_first, 1, 0.004), 1);
  const Pose T_second = disturbed(T_first, 100 + GetParam(), 0.05, 0.05);
  const Pose guess = disturbed(T_second, GetParam(), 0.02, 0.04);
  const auto found = match_scan(map, surfels_of(room, T_second, 2, 0.004), {guess, 0.05, 0.1}, 2);
  ASSERT_TRUE(found) << found.error().message;
  EXPECT_LT(distance_m(found->T_map_sensor, T_second), 0.008);
  EXPECT_LT(angle_between_rad(found->T_map_sensor, T_second), 0.005);
  EXPECT_GT(found->overlap, 0.8);
  EXPECT_EQ(found->unobserved, 0);
  EXPECT_LT((found->observed - Matrix6d::Identity()).norm(), 1e-9);
}

TEST_P(ScanMatchLaw, MovingMapAndGuessMovesTheAnswerEqually) {
  const auto room = furnished_room(GetParam());
  const Pose T = looking({3, 2.5, 1.2}, 0.5 * GetParam(), 0.1);
  const Pose T_other_map = disturbed(Pose::Identity(), GetParam(), 1.0, 3.0);
  const auto first = surfels_of(room, T, 1, 0.002),
             second = surfels_of(room, disturbed(T, 7, 0.02, 0.03), 2, 0.002);
  LocalMap here, there;
  here.insert(T, first, 1);
  there.insert(T_other_map * T, first, 1);
  const auto a = match_scan(here, second, {T, 0.1, 0.2}, 2);
  const auto b = match_scan(there, second, {T_other_map * T, 0.1, 0.2}, 2);
  ASSERT_TRUE(a && b);
  EXPECT_LT(distance_m(T_other_map * a->T_map_sensor, b->T_map_sensor), 0.006);  // the cells lie differently
  EXPECT_LT(angle_between_rad(T_other_map * a->T_map_sensor, b->T_map_sensor), 0.004);
}

TEST_P(ScanMatchLaw, APersonInViewDoesNotMoveTheAnswer) {
  const Person person{.stood = {{3.0, 2.2, 0}, {3.4, 2.6, 1.8}}, .frames = 4, .step = {0.08, 0.1, 0}};
  const Pose T = looking({1.5, 2.5, 1.2}, 0, 0.1);
  EXPECT_LT(error_m(furnished_room(GetParam()), person, {T, 0.02, 0.1}, from_ms(1000)), 0.01);
}

/// Close by he has more surfels than all else that shows motion along his way.
TEST_P(ScanMatchLaw, APersonWhoStoodCloseByAndWalksOffDoesNotTakeTheDeviceAlong) {
  const Person person{.stood = {{2.2, 2.2, 0}, {2.6, 2.7, 1.8}}, .frames = 6, .step = {0.025, 0, 0}};
  const Pose T = looking({1.0, 2.5, 1.2}, 0, 0.1);
  EXPECT_LT(error_m(furnished_room(GetParam()), person, {T, 0.025, 0.014}, from_ms(1900)), 0.004);
}

INSTANTIATE_TEST_SUITE_P(Seeds, ScanMatchLaw, testing::Range(1U, 9U));

TEST(ScanMatch, ADirectionThatTheSceneDoesNotShowFollowsTheGuess) {
  const auto room = corridor();
  const Pose T = looking({0, 1, 1.2}, 1.5707963, 0.4);  // at a bare wall and the floor
  LocalMap map;
  map.insert(T, surfels_of(room, T, 1, 0.003), 1);
  Pose guess = T;
  guess.translation() += Eigen::Vector3d(0.06, 0.02, 0.02);
  const auto found = match_scan(map, surfels_of(room, T, 2, 0.003), {guess, 0.02, 0.02}, 2);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->T_map_sensor.translation().x(), 0.06, 0.01);  // along the wall: the guess
  EXPECT_NEAR(found->T_map_sensor.translation().y(), 1.0, 0.006);  // towards it: the scan
  EXPECT_NEAR(found->T_map_sensor.translation().z(), 1.2, 0.006);
  EXPECT_GE(found->unobserved, 1);
  EXPECT_LT(found->observed(3, 3), 0.1);  // along the wall
  EXPECT_GT(found->observed(4, 4), 0.9);
  EXPECT_GT(found->observed(5, 5), 0.9);
}

TEST(ScanMatch, AGuessThatTheNeighboursDoubtIsStillCorrelatedWithWhatTheSceneShows) {
  const auto room = corridor();
  const Pose T = looking({0, 1, 1.2}, 1.5707963, 0.4);
  LocalMap map;
  map.insert(T, surfels_of(room, T, 1, 0.003), 1);
  Pose guess = T;
  guess.translation().y() += 0.04;
  MotionGuess doubtful(guess, 0.005, 0.05);  // who is off towards the wall is off by as much along it
  doubtful.covariance(3, 4) = doubtful.covariance(4, 3) = 0.95 * 0.05 * 0.05;
  const auto found = match_scan(map, surfels_of(room, T, 2, 0.003), doubtful, 2);
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->T_map_sensor.translation().y(), 1.0, 0.006);
  EXPECT_NEAR(found->T_map_sensor.translation().x(), -0.038, 0.01);
}

TEST(ScanMatch, APersonWhoWalksOffDoesNotTakeASureGuessAlong) {
  const Person person{// nothing else shows motion along the wall; 1 m/s
                      .stood = {{-0.4, 1.8, 0}, {0.1, 2.1, 1.8}},
                      .frames = 4,
                      .step = {0.07, 0, 0}};
  const Pose T = looking({0, 1, 1.2}, 1.5707963, 0.4);
  EXPECT_LT(error_m(corridor(), person, {T, 0.001, 0.004}, from_ms(970)), 0.006);
}

TEST(ScanMatch, SaysWhyItStopped) {
  const auto room = furnished_room(1);
  const Pose T = looking({2.6, 2.2, 1.2}, 0.7, 0.2);
  const auto frame = surfels_of(room, T, 1, 0.004);
  LocalMap map;
  map.insert(T, frame, 1);
  const auto stopped = [&](const Pose& T_guess, const ScanMatchOptions& options) {
    return match_scan(map, frame, {T_guess, 0.02, 0.02}, 2, options)->stop;
  };
  EXPECT_EQ(stopped(T, {}), ScanStop::converged);
  ScanMatchOptions one_iteration;
  one_iteration.max_iterations = 1;
  EXPECT_EQ(stopped(disturbed(T, 1, 0.02, 0.02), one_iteration), ScanStop::iteration_limit);
  Pose T_far = T;
  T_far.translation().x() += 100;
  EXPECT_EQ(stopped(T_far, {}), ScanStop::too_few_pairs);
}

TEST(ScanMatch, AWidePriorIsMended) {
  const auto room = furnished_room(2);
  const Pose T = looking({2.6, 2.2, 1.2}, 1.4, 0.2);
  LocalMap map;
  map.insert(T, surfels_of(room, T, 1, 0.004), 1);
  const Pose T_second = disturbed(T, 5, 0.1, 0.1);
  for (unsigned seed = 1; seed <= 8; ++seed) {
    const Pose guess = disturbed(T_second, seed, 0.06, 0.2);
    const auto found = match_scan(map, surfels_of(room, T_second, 2, 0.004), {guess, 0.1, 0.2}, 2);
    ASSERT_TRUE(found);
    EXPECT_LT(distance_m(found->T_map_sensor, T_second), 0.015) << "seed " << seed;
  }
}

TEST(ScanMatch, WithoutAMapOrAFrameItIsAnError) {
  const Pose T = looking({2, 2, 1}, 0);
  LocalMap map;
  const auto frame = surfels_of(furnished_room(1), T, 1, 0);
  EXPECT_FALSE(match_scan(map, frame, {T, 0.1, 0.1}, 1));
  map.insert(T, frame, 1);
  EXPECT_FALSE(match_scan(map, {}, {T, 0.1, 0.1}, 1));
}

TEST(ScanMatch, AStrangeSceneIsAGradedResult) {
  const Pose T = looking({3, 2.5, 1.2}, 0);
  LocalMap map;
  map.insert(T, surfels_of(furnished_room(1), T, 1, 0.003), 1);
  const Pose T_far = looking({1.0, 1.0, 1.9}, 0.5, 0.6);
  const auto found = match_scan(map, surfels_of(furnished_room(5), T_far, 2, 0.003), {T, 0.02, 0.05}, 2);
  ASSERT_TRUE(found);
  EXPECT_LT(found->overlap, 0.3);
}

}  // namespace
}  // namespace liloc
