#include "common/registration/points/nearest_grid.hpp"

#include <gtest/gtest.h>

#include <random>

namespace liloc {
namespace {

class NearestGridLaw : public testing::TestWithParam<unsigned> {};

TEST_P(NearestGridLaw, IsAsNearAsBruteForceUpToACell) {
  std::mt19937 rng(GetParam());
  std::uniform_real_distribution<float> unit(-1.5F, 1.5F);
  std::vector<Eigen::Vector3f> points;
  for (int i = 0; i < 800; ++i) points.emplace_back(unit(rng), unit(rng), 0.3F * unit(rng));
  const double cell = 0.05, reach = 0.2, diagonal = cell * std::sqrt(3.0);
  const NearestGrid grid(points, cell, reach);
  for (int q = 0; q < 2000; ++q) {
    const Eigen::Vector3f p(1.3F * unit(rng), 1.3F * unit(rng), unit(rng));
    float least = 1e9F;
    for (const auto& point : points) least = std::min(least, (point - p).norm());
    const std::int32_t found = grid.nearest(p);
    if (found == NearestGrid::kNone)
      EXPECT_GT(least, reach - diagonal / 2 - 1e-4);
    else
      EXPECT_LT((points[static_cast<std::size_t>(found)] - p).norm(), least + diagonal + 1e-4);
  }
}

TEST_P(NearestGridLaw, OfManyPointsEachGetsItsOwn) {
  std::mt19937 rng(GetParam());
  std::uniform_real_distribution<float> unit(-1.5F, 1.5F);
  std::vector<Eigen::Vector3f> points, asked;
  for (int i = 0; i < 300; ++i) points.emplace_back(unit(rng), unit(rng), 0.3F * unit(rng));
  for (int i = 0; i < 1003; ++i) asked.emplace_back(1.3F * unit(rng), 1.3F * unit(rng), unit(rng));
  asked.emplace_back(1e6F, -1e6F, 0);
  const Eigen::Vector3f shift(0.1F, -0.2F, 0.05F);
  for (const NearestGrid& grid : {NearestGrid(points, 0.05, 0.2), NearestGrid({}, 0.05, 0.2)}) {
    std::vector<std::int32_t> found(asked.size(), 7);
    grid.nearest(Vectors(asked).run(0, asked.size()), shift, found.data());
    for (std::size_t i = 0; i < asked.size(); ++i) ASSERT_EQ(found[i], grid.nearest(asked[i] + shift)) << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, NearestGridLaw, testing::Range(1U, 5U));

TEST_P(NearestGridLaw, OfRoomsThatLieFarApartIsThatOfEach) {
  std::mt19937 rng(GetParam());
  std::uniform_real_distribution<float> unit(-1.5F, 1.5F);
  const std::vector<Eigen::Vector3f> rooms{{0, 0, 0}, {700, -300, 0}, {60, 900, 2}};
  std::vector<Eigen::Vector3f> points, asked;
  for (int i = 0; i < 900; ++i)
    points.emplace_back(rooms[static_cast<std::size_t>(i) % 3] +
                        Eigen::Vector3f(unit(rng), unit(rng), unit(rng)));
  for (int i = 0; i < 900; ++i)
    asked.emplace_back(rooms[static_cast<std::size_t>(i) % 3] +
                       1.3F * Eigen::Vector3f(unit(rng), unit(rng), unit(rng)));
  asked.emplace_back(350, 100, 0);
  const NearestGrid grid(points, 0.05, 0.2);
  std::vector<std::int32_t> found(asked.size(), 7);
  grid.nearest(Vectors(asked).run(0, asked.size()), Eigen::Vector3f::Zero(), found.data());
  int none = 0;
  for (std::size_t i = 0; i < asked.size(); ++i) {
    float least = 1e9F;
    for (const auto& point : points) least = std::min(least, (point - asked[i]).norm());
    ASSERT_EQ(found[i], grid.nearest(asked[i]));
    none += found[i] == NearestGrid::kNone;
    if (found[i] == NearestGrid::kNone)
      EXPECT_GT(least, 0.2 - 0.045);
    else
      EXPECT_LT((points[static_cast<std::size_t>(found[i])] - asked[i]).norm(), least + 0.09);
  }
  EXPECT_GT(none, 10);
  EXPECT_LT(none, 800);
}

TEST_P(NearestGridLaw, OfFarRoomsIsTakenOverWhereTheyChange) {
  std::mt19937 rng(GetParam());
  std::uniform_real_distribution<float> unit(-1.5F, 1.5F);
  Cloud before;
  for (int i = 0; i < 800; ++i)
    before.points.emplace_back((i % 2 == 0 ? 0.0F : 500.0F) + unit(rng), unit(rng), 0.3F * unit(rng));
  Cloud now = before;
  now.points.erase(now.points.begin() + 10, now.points.begin() + 20);
  for (int i = 0; i < 6; ++i) now.points.emplace_back((i % 2 == 0 ? 0.0F : 500.0F), 0.2F * unit(rng), 0.1F);
  const NearestGrid was(before.points, 0.05, 0.2), anew(now.points, 0.05, 0.2),
      taken(now.points, 0.05, 0.2, was, change_between(before, now));
  for (int i = 0; i < 4000; ++i) {
    const Eigen::Vector3f p((i % 2 == 0 ? 0.0F : 500.0F) + unit(rng), unit(rng), 0.3F * unit(rng));
    ASSERT_EQ(taken.nearest(p), anew.nearest(p));
  }
}

TEST(NearestGrid, EmptyAndHostileInput) {
  EXPECT_EQ(NearestGrid().nearest({0, 0, 0}), NearestGrid::kNone);
  EXPECT_EQ(NearestGrid({}, 0.05, 0.1).nearest({0, 0, 0}), NearestGrid::kNone);
  const NearestGrid grid({{0, 0, 0}, {NAN, 0, 0}, {INFINITY, 0, 0}}, 0.05, 0.1);
  EXPECT_EQ(grid.nearest({0.01F, 0, 0}), 0);
  EXPECT_EQ(grid.nearest({NAN, 0, 0}), NearestGrid::kNone);
  EXPECT_EQ(grid.nearest({1e30F, 0, 0}), NearestGrid::kNone);
}

TEST(NearestGrid, AHugeExtentGetsLargerCellsNotAllMemory) {
  const NearestGrid grid({{0, 0, 0}, {5000, 5000, 5000}}, 0.05, 0.1);
  EXPECT_NE(grid.nearest({0, 0, 0}), NearestGrid::kNone);
}

}  // namespace
}  // namespace liloc
