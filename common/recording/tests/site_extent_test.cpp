#include "common/recording/site_extent.hpp"

#include <gmock/gmock.h>

namespace liloc {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using Places = std::vector<Eigen::Vector3d>;

Status extent_of(const Places& places) {
  std::vector<GlobalLidar> lidars;
  for (const Eigen::Vector3d& place : places) {
    GlobalLidar lidar;
    lidar.id = "c" + std::to_string(lidars.size());
    lidar.T_map_sensor = Pose::Identity();
    lidar.T_map_sensor.translation() = place;
    lidars.push_back(lidar);
  }
  return check_extent("site.json", lidars);
}

TEST(SiteExtent, RoomsMayLieFarApart) {
  EXPECT_TRUE(extent_of({}));
  EXPECT_TRUE(extent_of({{1, 2, 3}}));
  EXPECT_TRUE(extent_of({{0, 0, 3}, {9, 7, 3}, {900, 400, 3}, {-300, -700, 20}}));
  EXPECT_TRUE(extent_of({{15'000, 12'000, 520}, {15'009, 12'007, 520}})) << "wherever the map begins";
  Places hall;
  for (int i = 0; i < 64; ++i) hall.emplace_back(10 * (i % 8), 10 * (i / 8), 8);
  EXPECT_TRUE(extent_of(hall));
}

TEST(SiteExtent, WhatNoSiteSpansIsRefusedByNameAndRemedy) {
  const auto why = [](const Places& places) {
    const Status extent = extent_of(places);
    return extent ? std::string("none") : extent.error().message;
  };
  const auto names = [](int index) {
    return AllOf(HasSubstr("site.json: global_lidars[" + std::to_string(index) + "].T_map_sensor.translation"),
                 HasSubstr("give metres"));
  };
  EXPECT_THAT(why({{0, 0, 3}, {9, 7, 3}, {60'000, 0, 3}}), names(2));
  EXPECT_THAT(why({{0, 0, 3}, {1021, 0, 3}}),
              AllOf(names(1), HasSubstr("c1 hangs 1021 m from the middle one")));
  EXPECT_THAT(why({{0, 0, 60'000}, {9, 7, 3}}), AllOf(names(0), HasSubstr("above c1")));
  EXPECT_THAT(why({{0, 0, 3}, {9, 7, 3}, {5, 5, 3}, {5, 6, -3000}}), AllOf(names(3), HasSubstr("below")));
  EXPECT_THAT(why({{50'000, 30'000, 3}, {50'009, 30'007, 3}}),
              AllOf(names(0), HasSubstr("from the map's origin"), HasSubstr("subtract a common offset")));
  EXPECT_THAT(why({{350, 350, 3450}, {9650, 350, 3450}, {5000, 7700, 3450}}), HasSubstr("give metres"));
  Places chain;
  for (int i = 0; i < 12; ++i) chain.emplace_back(18 * i, 18 * i, 3);
  EXPECT_THAT(why(chain), HasSubstr("rooms that hang together span at most 10000 m2"));
}

}  // namespace
}  // namespace liloc
