#include "common/registration/search/gravity_search.hpp"

#include <gtest/gtest.h>

#include "common/registration/spot/spot.hpp"
#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

bool near(const Pose& a, const Pose& b) {
  return distance_m(a, b) < 0.1 && degrees(angle_between_rad(a, b)) < 3;
}

class GravitySearchLaw : public testing::TestWithParam<unsigned> {};

TEST_P(GravitySearchLaw, OneThreadAndTwoFindTheSamePlace) {
  const WatchedRoom w = watched_room(GetParam());
  GravitySearchOptions two;
  two.threads = 2;
  const auto a = judge_candidates(w.problem(), gravity_search(w.target, w.query, w.up_device, {}));
  const auto b = judge_candidates(w.problem(), gravity_search(w.target, w.query, w.up_device, two));
  ASSERT_TRUE(!a.empty() && !b.empty());
  EXPECT_TRUE(near(a.front().T_map_sensor(), b.front().T_map_sensor()));
}

INSTANTIATE_TEST_SUITE_P(Seeds, GravitySearchLaw, testing::Range(1U, 7U));

TEST(GravitySearch, NothingToSearchIsAnEmptyList) {
  const WatchedRoom w = watched_room(1);
  const Target nothing = make_target({}, {}, 0.05);
  EXPECT_TRUE(gravity_search(nothing, w.query, w.up_device).empty());
  EXPECT_TRUE(gravity_search(w.target, Query{}, w.up_device).empty());
}

}  // namespace
}  // namespace liloc
