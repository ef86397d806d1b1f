#include "common/registration/search/up.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

double apart_deg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return degrees(std::acos(std::clamp(a.dot(b), -1.0, 1.0)));
}

Eigen::Vector3d up_in(const Pose& T_map_sensor) {
  return T_map_sensor.linear().transpose() * Eigen::Vector3d::UnitZ();
}

/// A device somewhere in the middle of the room that looks anywhere, held as `roll` and `pitch` say.
Pose held(std::mt19937& rng, double most_roll, double low_pitch, double high_pitch) {
  std::uniform_real_distribution<double> unit(0, 1);
  Pose T = scene::looking({2.2 + 1.6 * unit(rng), 1.8 + 1.2 * unit(rng), 0.8 + 0.8 * unit(rng)},
                          2 * M_PI * unit(rng), low_pitch + (high_pitch - low_pitch) * unit(rng));
  T.rotate(Eigen::AngleAxisd(most_roll * (2 * unit(rng) - 1), Eigen::Vector3d::UnitZ()));
  return T;
}

class UpLaw : public testing::TestWithParam<unsigned> {};

TEST_P(UpLaw, OfADeviceHeldUprightIsTheFirst) {
  std::mt19937 rng(GetParam());
  const Pose T = held(rng, radians(25), radians(0), radians(45));
  const auto found = find_up(look(scene::furnished_room(GetParam()), T, GetParam()).medium);
  ASSERT_FALSE(found.empty());
  EXPECT_LT(apart_deg(found.front().up, up_in(T)), 1.5);
  EXPECT_GT(found.front().confidence, 0);
  EXPECT_LE(found.front().confidence, 1);
}

TEST_P(UpLaw, OfADeviceHeldAnyhowIsAmongThem) {
  std::mt19937 rng(100 + GetParam());
  const Pose T = held(rng, M_PI, radians(-60), radians(60));
  const auto found =
      find_up(look(scene::furnished_room(GetParam()), T, GetParam()).medium, {Eigen::Vector3d::Zero(), 8});
  EXPECT_TRUE(std::any_of(found.begin(), found.end(),
                          [&](const UpHypothesis& h) { return apart_deg(h.up, up_in(T)) < 2; }));
}

TEST_P(UpLaw, TurnsWithTheCloud) {
  std::mt19937 rng(200 + GetParam());
  const Query query = look(scene::furnished_room(GetParam()), held(rng, 0.2, 0.1, 0.6), GetParam());
  Vector6d a;
  a << 0.7, -1.1, 0.4, 3, -2, 1;
  const Pose turn = increment(a);
  const auto here = find_up(query.medium);
  const auto there = find_up(transformed(turn, query.medium), {turn.linear() * UpOptions{}.expected, 4});
  ASSERT_FALSE(here.empty() || there.empty());
  EXPECT_LT(apart_deg(turn.linear() * here.front().up, there.front().up), 0.2);
}

TEST_P(UpLaw, AMapThatIsNotLevelIsFoundOut) {
  std::mt19937 rng(300 + GetParam());
  std::uniform_real_distribution<double> tilt(15, 35), way(0, 2 * M_PI);
  const double towards = way(rng);
  Pose T_map_room = Pose::Identity();
  T_map_room.linear() = so3_exp(radians(tilt(rng)) * Eigen::Vector3d(std::cos(towards), std::sin(towards), 0));
  Eigen::Vector3d expected = Eigen::Vector3d::Zero();
  for (const Pose& T : ceiling_poses())
    expected += T_map_room.linear() * T.linear() * Eigen::Vector3d(0, -1, -0.5);
  const scene::BoxRoom room = scene::furnished_room(GetParam());
  const Target tilted = watch(room, GetParam(), 0.005, T_map_room), level = watch(room, GetParam());
  EXPECT_LT(apart_deg(up_of_map(tilted->coarse, expected), T_map_room.linear().col(2)), 1.0);
  EXPECT_EQ(up_of_map(level->coarse, T_map_room.linear().transpose() * expected), Eigen::Vector3d::UnitZ());
}

INSTANTIATE_TEST_SUITE_P(Seeds, UpLaw, testing::Range(1U, 17U));

TEST(FindUp, WithoutPlanesThereIsNone) {
  EXPECT_TRUE(find_up({}).empty());
  Cloud bare;
  bare.points.assign(500, {1, 2, 3});
  EXPECT_TRUE(find_up(bare).empty()) << "no normals";
  std::mt19937 rng(7);
  std::normal_distribution<float> unit(0, 1);
  Cloud ball;
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector3f n = Eigen::Vector3f(unit(rng), unit(rng), unit(rng)).normalized();
    ball.points.emplace_back(-n);
    ball.normals.push_back(n);
  }
  for (const UpHypothesis& h : find_up(ball)) EXPECT_LT(h.confidence, 0.3);
  Cloud broken;
  broken.points.assign(100, {0, 0, 1});
  broken.normals.assign(100, Eigen::Vector3f::Constant(NAN));
  EXPECT_TRUE(find_up(broken).empty());
}

}  // namespace
}  // namespace liloc
