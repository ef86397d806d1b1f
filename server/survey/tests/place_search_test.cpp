#include "server/survey/place_search.hpp"

#include <gtest/gtest.h>

#include "server/survey/tests/ceiling.hpp"

namespace liloc::survey {
namespace {

constexpr std::uint64_t kSeed = 1;

/// Found, and told to be the only such place.
bool sure(const std::optional<FoundPlace>& place) {
  return place && !place->twin;
}

void expect_near(const FoundPlace& place, const Pose& T_map_sensor, std::size_t i) {
  EXPECT_LT(distance_m(place.T_map_sensor, T_map_sensor), 0.3) << i;
  EXPECT_LT(degrees(angle_between_rad(place.T_map_sensor, T_map_sensor)), 10) << i;
}

class PlaceSearch : public testing::TestWithParam<unsigned> {};

TEST_P(PlaceSearch, AScanOfTheRoomShowsWhereEachHangs) {
  const auto all = test::scans(GetParam());
  Cloud room = test::rest_of(all, all.size());
  room.normals.clear();
  const Reference reference = Reference::create(room, test::kVoxel_m).value();
  int found = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    const auto place = find_in_scan(all[i], reference, kSeed);
    if (!sure(place)) continue;
    expect_near(*place, test::hung()[i], i);
    ++found;
  }
  EXPECT_GE(found, 2);
}

TEST_P(PlaceSearch, WhoIsJoinedToOthersSurelyIsThere) {
  const auto all = test::scans(GetParam());
  const auto places = find_by_overlap(all, {false, true, true}, kSeed);
  ASSERT_EQ(places.size(), 3U);
  EXPECT_FALSE(places[0]) << "it was not asked for";
  for (std::size_t i = 1; i < places.size(); ++i)
    if (sure(places[i])) expect_near(*places[i], test::hung()[i], i);
}

TEST_P(PlaceSearch, WithNobodyPlacedNobodyIsFound) {
  for (const auto& place : find_by_overlap(test::scans(GetParam()), {true, true, true}, kSeed))
    EXPECT_FALSE(place);
}

INSTANTIATE_TEST_SUITE_P(Seeds, PlaceSearch, testing::Range(1U, 3U));

}  // namespace
}  // namespace liloc::survey
