#include "common/geometry/extent.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace liloc {
namespace {

TEST(Extent, IsThatOfTheLongestAxisWithoutStrays) {
  Cloud cloud;
  for (int i = 0; i <= 1000; ++i)
    cloud.points.emplace_back(0.001F * static_cast<float>(i), 5, 0.004F * static_cast<float>(i));
  EXPECT_NEAR(extent_m(cloud), 3.84, 0.02);
  cloud.points.emplace_back(1e6F, -1e6F, 1e6F);
  cloud.points.emplace_back(NAN, 0, 0);
  EXPECT_NEAR(extent_m(cloud), 3.84, 0.02);
}

TEST(Extent, OfNothingIsNone) {
  EXPECT_EQ(extent_m({}), 0);
  EXPECT_EQ(extent_m({{{NAN, 0, 0}}, {}}), 0);
  EXPECT_EQ(extent_m({{{1, 2, 3}}, {}}), 0);
}

}  // namespace
}  // namespace liloc
