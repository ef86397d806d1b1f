#include "common/geometry/regions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace liloc {
namespace {

/// A room of points about a place.
void add_room(std::vector<Eigen::Vector3f>* points, float x, float y, unsigned seed, float half_m = 5) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<float> unit(-half_m, half_m);
  for (int i = 0; i < 300; ++i) points->emplace_back(x + unit(rng), y + unit(rng), std::abs(unit(rng)));
}

class RegionsLaw : public testing::TestWithParam<unsigned> {};

TEST_P(RegionsLaw, HoldAllPointsAndLieApart) {
  std::mt19937 rng(GetParam());
  std::uniform_real_distribution<float> place(-300, 300);
  std::vector<Eigen::Vector3f> points;
  for (unsigned i = 0; i < 12; ++i) add_room(&points, place(rng), place(rng), i);
  const auto regions = regions_of(points, 20);
  for (const Eigen::Vector3f& p : points) {
    int holders = 0;
    for (const Region& region : regions) holders += region.contains(p.head<2>().cast<double>().eval()) ? 1 : 0;
    ASSERT_EQ(holders, 1);
  }
  for (std::size_t i = 0; i < regions.size(); ++i)
    for (std::size_t j = i + 1; j < regions.size(); ++j) {
      const Eigen::Array2d gap = regions[i].min().array().max(regions[j].min().array()) -
                                 regions[i].max().array().min(regions[j].max().array());
      EXPECT_GE(gap.maxCoeff(), 20);
    }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RegionsLaw, testing::Range(1U, 9U));

TEST(Regions, OneRoomIsOneAndTwoFarOnesAreTwo) {
  std::vector<Eigen::Vector3f> points;
  add_room(&points, 0, 0, 1);
  EXPECT_EQ(regions_of(points, 20).size(), 1U);
  add_room(&points, 25, 0, 2);
  EXPECT_EQ(regions_of(points, 20).size(), 1U) << "15 m between them";
  add_room(&points, 0, 1000, 3);
  const auto regions = regions_of(points, 20);
  ASSERT_EQ(regions.size(), 2U);
  EXPECT_LT(regions[0].volume() + regions[1].volume(), 500) << "m2, whatever lies between";
}

TEST(Regions, OfNothingAreNoneAndWhatIsNotFiniteCountsNot) {
  EXPECT_TRUE(regions_of({}, 20).empty());
  EXPECT_TRUE(regions_of({{NAN, 0, 0}}, 20).empty());
  EXPECT_EQ(regions_of({{0, 0, 0}, {INFINITY, 0, 0}, {1e30F, 0, 0}}, 20).size(), 2U);
}

TEST(Regions, PointsThatAreScatteredEverywhereAreOne) {
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 2000; ++i)
    points.emplace_back(100.0F * static_cast<float>(i % 50), 100.0F * static_cast<float>(i / 50), 0);
  const auto regions = regions_of(points, 20);
  ASSERT_EQ(regions.size(), 1U);
  for (const Eigen::Vector3f& p : points) ASSERT_TRUE(regions[0].contains(p.head<2>().cast<double>().eval()));
}

TEST(Regions, EverywhereHoldsAnyPlace) {
  EXPECT_TRUE(everywhere().contains(Eigen::Vector2d(1e30, -1e30)));
  EXPECT_TRUE(merged({Region()}, 20).empty());
}

}  // namespace
}  // namespace liloc
