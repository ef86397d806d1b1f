#include "common/registration/points/neighbors.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "common/registration/points/tests/wavy_sheet.hpp"

namespace liloc {
namespace {

class RadiusSearchLaw : public testing::TestWithParam<unsigned> {};

TEST_P(RadiusSearchLaw, NeighborhoodsAreWhatBruteForceFinds) {
  Cloud sheet = wavy_sheet(GetParam());
  sheet.points.emplace_back(NAN, 0.0F, 0.0F);
  sheet.points.emplace_back(1e30F, -1e30F, 0.0F);  // beyond what a cell's key can tell
  const RadiusSearch search(sheet.points, 0.15);
  std::size_t visited = 0;
  search.for_each_neighborhood([&](std::uint32_t i, const RadiusSearch::Neighborhood& near) {
    ++visited;
    const Eigen::Vector3f& p = sheet.points[i];
    if (std::abs(p.x()) > 2) return;
    std::vector<std::uint32_t> expected, found(near.index.begin(), near.index.end());
    for (std::uint32_t k = 0; k < sheet.size(); ++k)
      if ((sheet.points[k] - p).norm() <= 0.15F) expected.push_back(k);
    std::ranges::sort(found);
    ASSERT_EQ(found, expected);
    for (std::size_t k = 0; k < near.index.size(); ++k)
      ASSERT_NEAR(std::sqrt(near.squared[k]), (sheet.points[near.index[k]] - p).norm(), 1e-5F);
  });
  EXPECT_EQ(visited, sheet.size() - 1) << "all but what is no number";
}

INSTANTIATE_TEST_SUITE_P(Seeds, RadiusSearchLaw, testing::Range(1U, 5U));

}  // namespace
}  // namespace liloc
