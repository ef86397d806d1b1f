#include "common/registration/search/gravity_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>

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

TEST_P(GravitySearchLaw, OfTwoRoomsThatLieFarApartItFindsTheRightOne) {
  const WatchedRoom here = watched_room(GetParam()), there = watched_room(GetParam() + 6);
  Pose T_map_there = Pose::Identity();
  T_map_there.translation() = Eigen::Vector3d(600, -350, 0);
  const Target far = watch(there.room, GetParam() + 6, 0.005, T_map_there);
  Cloud both = here.target->cloud;
  append(both, far->cloud);
  std::vector<SightView> views = here.target.views;
  views.insert(views.end(), far.views.begin(), far.views.end());
  const Target target = make_target(both, views, 0.05);
  ASSERT_EQ(target->field_fine().regions().size(), 2U);
  std::size_t cells = 0;
  for (const ScoreField& field : target->field_fine().regions())
    cells += static_cast<std::size_t>(field.size().cast<std::int64_t>().prod());
  EXPECT_LT(cells, 500'000U) << "of two rooms of 6 x 5 m, not of the space between";
  const auto finds = [](const Target& room, const WatchedRoom& w, const Pose& T_map_device) {
    return std::ranges::any_of(gravity_search(room, w.query, w.up_device, {}),
                               [&](const Candidate& c) { return near(c.T_map_sensor, T_map_device); });
  };
  const Pose T_map_there_device = T_map_there * there.T_map_device;
  EXPECT_TRUE(!finds(here.target, here, here.T_map_device) || finds(target, here, here.T_map_device));
  EXPECT_TRUE(!finds(far, there, T_map_there_device) || finds(target, there, T_map_there_device));
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
