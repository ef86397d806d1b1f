#include "common/registration/features/feature_match.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "common/registration/features/fpfh.hpp"
#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

class FeatureMatchLaw : public testing::TestWithParam<unsigned> {};

TEST_P(FeatureMatchLaw, BlocksFindTheNearestDescriptor) {
  const Cloud cloud = watched_room(GetParam()).query.medium;
  const Features room = fpfh(cloud, sample_indices(cloud.size(), 0.5, 1), 0.4),
                 device = fpfh(cloud, sample_indices(cloud.size(), 0.1, 2), 0.3);
  std::vector<std::uint32_t> odd, even;
  for (std::uint32_t i = 0; i < room.size(); ++i) (i % 2 == 0 ? even : odd).push_back(i);
  std::vector<FeatureBlock::Nearest> nearest(device.size());
  for (const auto* columns : {&odd, &even}) FeatureBlock(room, *columns).improve(device, &nearest);
  ASSERT_GT(device.size(), 10U);
  for (std::size_t i = 0; i < device.size(); ++i) {
    const auto asked = device.descriptors.col(static_cast<Eigen::Index>(i));
    const float least = (room.descriptors.colwise() - asked).colwise().norm().minCoeff();
    EXPECT_LE((room.descriptors.col(nearest[i].column) - asked).norm(), least * 1.001F + 0.1F);
  }
}

/// A network's have 16 or 32 dimensions; what is no multiple of a register comes out right, too.
TEST_P(FeatureMatchLaw, AnyNumberOfDimensionsWillDo) {
  std::mt19937_64 rng(GetParam());
  std::normal_distribution<float> normal;
  for (const Eigen::Index dimensions : {1, 16, 32, 37}) {
    Features room, device;
    for (auto& [features, count] : {std::pair{&room, 50U}, std::pair{&device, 7U}}) {
      features->index.resize(count);
      features->descriptors = Eigen::MatrixXf::NullaryExpr(dimensions, count, [&] { return normal(rng); });
    }
    std::vector<std::uint32_t> all(room.size());
    std::iota(all.begin(), all.end(), 0U);
    std::vector<FeatureBlock::Nearest> nearest(device.size());
    FeatureBlock(room, all).improve(device, &nearest);
    for (std::size_t i = 0; i < device.size(); ++i) {
      Eigen::Index expected = 0;
      const auto asked = device.descriptors.col(static_cast<Eigen::Index>(i));
      (room.descriptors.colwise() - asked).colwise().norm().minCoeff(&expected);
      EXPECT_EQ(nearest[i].column, static_cast<std::uint32_t>(expected)) << dimensions << " dimensions";
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, FeatureMatchLaw, testing::Range(1U, 4U));

}  // namespace
}  // namespace liloc
