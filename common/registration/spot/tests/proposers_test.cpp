#include "common/registration/spot/proposers.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/registration/search/up.hpp"
#include "common/registration/spot/spot.hpp"
#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

double apart_deg(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return degrees(std::acos(std::clamp(a.dot(b), -1.0, 1.0)));
}

class ProposersLaw : public testing::TestWithParam<unsigned> {};

bool near(const Pose& a, const Pose& b) {
  return distance_m(a, b) < 0.1 && degrees(angle_between_rad(a, b)) < 3;
}

TEST_P(ProposersLaw, GravityFindsTheDeviceCold) {
  const WatchedRoom w = watched_room(GetParam());
  const auto found = judge_candidates(w.problem(), GravityProposer().propose(w.problem()));
  ASSERT_FALSE(found.empty());
  EXPECT_TRUE(near(found.front().T_map_sensor(), w.T_map_device));
}

TEST_P(ProposersLaw, PastItsTimeTheSearchEndsWithWhatItHas) {
  const WatchedRoom w = watched_room(GetParam());
  SpotProblem problem = w.problem();
  EXPECT_FALSE(GravityProposer().propose(problem).empty());
  problem.search_limit = std::chrono::seconds(0);
  EXPECT_TRUE(GravityProposer().propose(problem).empty());
}

TEST_P(ProposersLaw, TheDeviceIsFoundInAMapThatIsNotLevel) {
  const WatchedRoom w = watched_room(GetParam());
  Pose T_map_room = Pose::Identity();
  T_map_room.linear() = so3_exp({radians(25), radians(-10), 0.3});
  const Target target = watch(w.room, GetParam(), 0.005, T_map_room);
  SpotProblem problem{target, w.query};
  problem.up_map = T_map_room.linear().col(2);
  const auto ups = ups_to_try(problem);
  ASSERT_FALSE(ups.empty());
  const auto found = judge_candidates(problem, GravityProposer(ups.front()).propose(problem));
  ASSERT_FALSE(found.empty());
  EXPECT_LT(distance_m(found.front().T_map_sensor(), T_map_room * w.T_map_device), 0.1);
  EXPECT_LT(degrees(angle_between_rad(found.front().T_map_sensor(), T_map_room * w.T_map_device)), 3);
}

TEST_P(ProposersLaw, AToldUpIsOnlyContradictedWhenItIsWrong) {
  const WatchedRoom w = watched_room(GetParam());
  SpotProblem problem = w.problem();
  EXPECT_EQ(ups_to_try(problem).size(), 1U);
  problem.up_sensor = so3_exp({0, 0, radians(10)}) * w.up_device;
  const auto ups = ups_to_try(problem);
  ASSERT_EQ(ups.size(), 2U);
  EXPECT_EQ(ups[0].sensor, *problem.up_sensor);
  EXPECT_LT(apart_deg(ups[1].sensor, w.up_device), 1.5);
}

TEST_P(ProposersLaw, WithoutAWordOfTheDeviceTheLikeliestDirectionAloneIsSearched) {
  const WatchedRoom w = watched_room(GetParam());
  SpotProblem problem{w.target, w.query};
  const auto ups = ups_to_try(problem);
  ASSERT_EQ(ups.size(), 1U);
  EXPECT_EQ(ups[0].map, Eigen::Vector3d::UnitZ());
  EXPECT_EQ(ups[0].sensor, find_up(w.query.medium).front().up);
}

INSTANTIATE_TEST_SUITE_P(Seeds, ProposersLaw, testing::Range(1U, 9U));

TEST(GravityProposer, NeedsSomethingThatIsUp) {
  const WatchedRoom w = watched_room(1);
  SpotProblem blind = w.problem();
  blind.up_sensor.reset();
  EXPECT_TRUE(GravityProposer().propose(blind).empty());
  EXPECT_FALSE(GravityProposer(UpPair{w.up_device, Eigen::Vector3d::UnitZ()}).propose(blind).empty());
}

}  // namespace
}  // namespace liloc
