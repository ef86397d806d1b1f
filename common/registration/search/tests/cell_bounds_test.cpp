#include "common/registration/search/cell_bounds.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace liloc {
namespace {

class CellBoundsLaw : public testing::TestWithParam<unsigned> {};

TEST_P(CellBoundsLaw, NineteenOfTwentyOfTheSameKindPass) {
  std::mt19937 rng(GetParam());
  std::normal_distribution<double> fitness(0.5, 0.08);
  const Eigen::Vector3d place(10, -7, 1);
  CellBounds bounds;
  for (int i = 0; i < 1000; ++i) bounds.learn(place, fitness(rng));
  int passed = 0;
  for (int i = 0; i < 1000; ++i) passed += bounds.plausible(place, fitness(rng));
  EXPECT_NEAR(passed, 950, 40);
  EXPECT_FALSE(bounds.plausible(place, 0.2)) << "too little";
  EXPECT_FALSE(bounds.plausible(place, 0.8)) << "too much";
  EXPECT_TRUE(bounds.plausible(place + Eigen::Vector3d(20, 0, 0), 0.8)) << "nothing is known there";
}

TEST_P(CellBoundsLaw, MeanAndVarianceAreThoseOfTheSamples) {
  std::mt19937 rng(GetParam());
  std::uniform_real_distribution<double> fitness(0.2, 0.7);
  CellBounds bounds;
  std::vector<double> seen;
  for (int i = 0; i < CellBounds::kMostCounted; ++i) {
    seen.push_back(fitness(rng));
    bounds.learn({0, 0, 0}, seen.back());
  }
  double mean = 0, variance = 0;
  for (const double v : seen) mean += v / static_cast<double>(seen.size());
  for (const double v : seen) variance += (v - mean) * (v - mean) / static_cast<double>(seen.size());
  const CellBounds::Cell& cell = bounds.cells().begin()->second;
  EXPECT_NEAR(cell.mean, mean, 1e-12);
  EXPECT_NEAR(cell.variance, variance, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Seeds, CellBoundsLaw, testing::Range(1U, 9U));

TEST(CellBounds, FewRegistrationsBoundNothing) {
  CellBounds bounds;
  for (int i = 0; i + 1 < CellBounds::kFewest; ++i) bounds.learn({0, 0, 0}, 0.9);
  EXPECT_TRUE(bounds.plausible({0, 0, 0}, 0.1));
  bounds.learn({0, 0, 0}, 0.9);
  EXPECT_FALSE(bounds.plausible({0, 0, 0}, 0.1));
  EXPECT_TRUE(bounds.plausible({0, 0, 0}, 0.85)) << "alike registrations leave some room";
}

TEST(CellBounds, ARoomThatChangedIsLearnedAnew) {
  CellBounds bounds;
  for (int i = 0; i < 2000; ++i) bounds.learn({0, 0, 0}, 0.9);
  for (int i = 0; i < 2000; ++i) bounds.learn({0, 0, 0}, 0.4);
  EXPECT_TRUE(bounds.plausible({0, 0, 0}, 0.4));
  EXPECT_FALSE(bounds.plausible({0, 0, 0}, 0.9));
}

TEST(CellBounds, HostileValuesChangeNothingAndTheSizeIsBounded) {
  CellBounds bounds;
  bounds.learn({NAN, 0, 0}, 0.5);
  bounds.learn({1e300, 0, 0}, 0.5);
  bounds.learn({0, 0, 0}, NAN);
  bounds.learn({0, 0, 0}, 1.5);
  EXPECT_TRUE(bounds.cells().empty());
  EXPECT_FALSE(bounds.plausible({NAN, 0, 0}, 0.5));
  EXPECT_FALSE(bounds.restore({0, 0}, {0, 0.5, 0.01}));
  EXPECT_FALSE(bounds.restore({0, 0}, {201, 0.5, 0.01}));
  EXPECT_FALSE(bounds.restore({0, 0}, {5, NAN, 0.01}));
  EXPECT_FALSE(bounds.restore({0, 0}, {5, 0.5, -1}));
  EXPECT_FALSE(bounds.restore({1 << 30, 0}, {5, 0.5, 0.01}));
  EXPECT_TRUE(bounds.restore({0, 0}, {5, 0.5, 0.01}));
  EXPECT_FALSE(bounds.restore({0, 0}, {5, 0.5, 0.01})) << "twice";
  for (int i = 0; i < 300; ++i)
    for (int j = 0; j < 300; ++j) bounds.learn({3.0 * i, 3.0 * j, 0}, 0.5);
  EXPECT_EQ(bounds.cells().size(), CellBounds::kMostCells);
}

}  // namespace
}  // namespace liloc
