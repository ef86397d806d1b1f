#include "common/base/quantile.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

namespace liloc {
namespace {

TEST(Quantile, IsOneOfTheValuesInTheirOrder) {
  EXPECT_EQ(median(std::vector<int>{7}), 7);
  EXPECT_EQ(median(std::vector<int>{5, 1, 3}), 3);
  EXPECT_EQ(median(std::vector<int>{4, 1, 3, 2}), 3);
  EXPECT_EQ(quantile(std::vector<double>{2, 1}, 0.0), 1);
  EXPECT_EQ(quantile(std::vector<double>{2, 1}, 1.0), 2);
}

TEST(Quantile, SoManyLieBelow) {
  std::vector<int> values(1000);
  std::iota(values.begin(), values.end(), 0);
  std::mt19937 random(1);
  std::shuffle(values.begin(), values.end(), random);
  for (const int percent : {0, 1, 10, 50, 90, 99}) EXPECT_EQ(quantile(values, 0.01 * percent), 10 * percent);
}

}  // namespace
}  // namespace liloc
