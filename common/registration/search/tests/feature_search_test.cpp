#include "common/registration/search/feature_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/registration/spot/spot.hpp"
#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

bool near(const Pose& a, const Pose& b) {
  return distance_m(a, b) < 0.1 && degrees(angle_between_rad(a, b)) < 3;
}

class FeatureSearchLaw : public testing::TestWithParam<unsigned> {};

TEST_P(FeatureSearchLaw, FeaturesNeedNoGravityAndTheirCellsNoOrder) {
  const WatchedRoom w = watched_room(GetParam());
  const Described room = describe(w.target->coarse, {0.5, 1.0, 1}),
                  device = describe(w.query.medium, {0.5, 1.0, 1});
  FeatureSearchOptions options;
  const auto one = feature_search(w.target, room, w.query, device, options);
  options.threads = 2;
  const auto two = feature_search(w.target, room, w.query, device, options);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) EXPECT_EQ(one[i].score, two[i].score);
  const auto found = judge_candidates(w.problem(), one);
  ASSERT_FALSE(found.empty());
  EXPECT_TRUE(near(found.front().T_map_sensor(), w.T_map_device));
}

TEST_P(FeatureSearchLaw, TwoNormalsFindThePlaceWithAThirdOfTheSamples) {
  const WatchedRoom w = watched_room(GetParam());
  const Described room = describe(w.target->coarse, {0.5, 1.0, 1}),
                  device = describe(w.query.medium, {0.5, 1.0, 1});
  FeatureSearchOptions options;
  options.sample = Sample::two_normals;
  options.iterations = 20000;
  const auto candidates = feature_search(w.target, room, w.query, device, options);
  const auto right = std::count_if(candidates.begin(), candidates.end(), [&](const Candidate& c) {
    return distance_m(c.T_map_sensor, w.T_map_device) < 0.3 &&
           degrees(angle_between_rad(c.T_map_sensor, w.T_map_device)) < 10;
  });
  EXPECT_GT(right, 0);
}

TEST_P(FeatureSearchLaw, CellsOverlapAndHoldEveryPointOfTheRoom) {
  const WatchedRoom w = watched_room(GetParam());
  const Described room = describe(w.target->coarse, {0.5, 1.0, 1});
  const auto [tiles, cells] = partition(room, 1.5, 20);
  EXPECT_GT(cells.size(), 1U);
  std::vector<int> held(room.features.size(), 0), once(room.features.size(), 0);
  for (const auto& cell : cells)
    for (const std::uint32_t tile : cell)
      for (const std::uint32_t k : tiles[tile]) ++held[k];
  for (const auto& tile : tiles)
    for (const std::uint32_t k : tile) ++once[k];
  EXPECT_EQ(std::count(once.begin(), once.end(), 1), static_cast<std::ptrdiff_t>(once.size()));
  const auto missed = std::count(held.begin(), held.end(), 0);
  EXPECT_LT(missed, static_cast<std::ptrdiff_t>(held.size() / 10));
}

INSTANTIATE_TEST_SUITE_P(Seeds, FeatureSearchLaw, testing::Range(1U, 7U));

TEST(Describe, ACloudOfAnySizeGivesABoundedNumberOfDescriptors) {
  const WatchedRoom w = watched_room(1);
  const Cloud& cloud = w.target->cloud;
  const auto described = [&](std::size_t most) { return describe(cloud, {0.5, 1.0, 1, most}).features.size(); };
  ASSERT_GT(cloud.size(), 2000U);
  EXPECT_EQ(described(1'000'000), described(cloud.size()));
  EXPECT_NEAR(static_cast<double>(described(500)), 500, 100);
}

TEST(Describe, ADescriberTakesThePlaceOfFpfh) {
  const WatchedRoom w = watched_room(1);
  const Cloud &dense = w.target->cloud, &thinned = w.target->coarse;
  DescribeOptions options{0.5, 0.3, 1};
  const Cloud* seen = nullptr;
  options.describer = [&](const Cloud& of, const Cloud& points, const std::vector<std::uint32_t>& index) {
    seen = &of;
    EXPECT_EQ(points.size(), thinned.size());
    return Features{{index.front()}, Eigen::MatrixXf::Constant(4, 1, 7)};
  };
  const Described described = describe(thinned, options, &dense);
  EXPECT_EQ(seen, &dense);
  EXPECT_EQ(described.features.index,
            std::vector<std::uint32_t>{sample_indices(thinned.size(), 0.3, 1).front()});
  EXPECT_EQ(described.features.descriptors, Eigen::MatrixXf::Constant(4, 1, 7));
  options.up = -Eigen::Vector3d::UnitX();
  options.describer = [&](const Cloud& of, const Cloud& points, const std::vector<std::uint32_t>& index) {
    EXPECT_NEAR(points.points[index.front()].z(), -thinned.points[index.front()].x(), 1e-4F);
    EXPECT_NEAR(of.points.front().z(), -dense.points.front().x(), 1e-4F);
    return Features{{}, {}};
  };
  (void)describe(thinned, options, &dense);
}

}  // namespace
}  // namespace liloc
