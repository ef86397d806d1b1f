#include <gtest/gtest.h>

#include <algorithm>

#include "common/registration/search/feature_search.hpp"
#include "common/registration/spot/align.hpp"
#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

bool near(const Pose& a, const Pose& b) {
  return distance_m(a, b) < 0.1 && degrees(angle_between_rad(a, b)) < 3;
}

class SearchLaw : public testing::TestWithParam<unsigned> {};

TEST_P(SearchLaw, GravityFindsTheDeviceCold) {
  const WatchedRoom w = watched_room(GetParam());
  const auto found = judge_candidates(w.problem(), GravityProposer().propose(w.problem()));
  ASSERT_FALSE(found.empty());
  EXPECT_TRUE(near(found.front().T_map_sensor(), w.T_map_device));
}

TEST_P(SearchLaw, PastItsTimeTheSearchEndsWithWhatItHas) {
  const WatchedRoom w = watched_room(GetParam());
  SpotProblem problem = w.problem();
  EXPECT_FALSE(GravityProposer().propose(problem).empty());
  problem.search_limit = std::chrono::seconds(0);
  EXPECT_TRUE(GravityProposer().propose(problem).empty());
}

TEST_P(SearchLaw, OneThreadAndTwoFindTheSamePlace) {
  const WatchedRoom w = watched_room(GetParam());
  GravitySearchOptions two;
  two.threads = 2;
  const auto a = judge_candidates(w.problem(), gravity_search(w.target, w.query, w.up_device, {}));
  const auto b = judge_candidates(w.problem(), gravity_search(w.target, w.query, w.up_device, two));
  ASSERT_TRUE(!a.empty() && !b.empty());
  EXPECT_TRUE(near(a.front().T_map_sensor(), b.front().T_map_sensor()));
}

TEST_P(SearchLaw, FeaturesNeedNoGravityAndTheirCellsNoOrder) {
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

TEST_P(SearchLaw, TwoNormalsFindThePlaceWithAThirdOfTheSamples) {
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

TEST_P(SearchLaw, CellsOverlapAndHoldEveryPointOfTheRoom) {
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

INSTANTIATE_TEST_SUITE_P(Seeds, SearchLaw, testing::Range(1U, 7U));

TEST(Search, NothingToSearchIsAnEmptyList) {
  const WatchedRoom w = watched_room(1);
  const Target nothing = make_target({}, {}, 0.05);
  EXPECT_TRUE(gravity_search(nothing, w.query, w.up_device).empty());
  EXPECT_TRUE(gravity_search(w.target, Query{}, w.up_device).empty());
  SpotProblem blind = w.problem();
  blind.up_sensor.reset();
  EXPECT_TRUE(GravityProposer().propose(blind).empty());
  EXPECT_TRUE(judge_candidates(w.problem(), {}).empty());
}

TEST(JudgeOptions, FollowTheVoxelSizeFromTheDefaults) {
  const JudgeOptions usual, same = judge_options_for(0.05), fine = judge_options_for(0.03);
  EXPECT_EQ(same.fine_tolerance_m, usual.fine_tolerance_m);
  EXPECT_EQ(same.sketch_tolerance_m, usual.sketch_tolerance_m);
  EXPECT_EQ(same.refine.end_distance_m, usual.refine.end_distance_m);
  EXPECT_EQ(same.refine.fit_distance_m, usual.refine.fit_distance_m);
  EXPECT_DOUBLE_EQ(fine.fine_tolerance_m, 0.03);
  EXPECT_DOUBLE_EQ(fine.refine.fit_distance_m, 0.03);
  EXPECT_GE(judge_options_for(0.08).sketch_tolerance_m, judge_options_for(0.08).fine_tolerance_m);
}

Cloud two_walls_and_a_box(unsigned seed) {
  const scene::BoxRoom room = scene::furnished_room(seed);
  Cloud cloud;
  for (double yaw = 0; yaw < 1.6; yaw += 0.5) {
    const Pose T = scene::looking({3, 2.5, 1.3}, yaw);
    append(cloud, transformed(T, *depth_to_cloud(scene::render(room, T, scene::small_camera(), 1, 0.004, seed),
                                                 scene::small_camera())));
  }
  return transformed(scene::looking({3, 2.5, 1.3}, 0.7).inverse(), cloud);
}

TEST(Align, MapsTheSourceIntoTheTarget) {
  for (unsigned seed : {1U, 2U, 3U}) {
    const Cloud target = two_walls_and_a_box(seed);
    Vector6d a;
    a << 0.2, 0.5, -0.1, 0.6, -0.2, 0.4;
    const Pose T_target_source = increment(a);
    const auto result = align_clouds(transformed(T_target_source.inverse(), target), target, {});
    ASSERT_TRUE(result);
    EXPECT_TRUE(near(result->T_target_source, T_target_source)) << "seed " << seed;
    EXPECT_GT(result->fitness, 0.9);
  }
}

TEST(Align, HostileCloudsAreErrorsOrUntrusted) {
  const Cloud good = two_walls_and_a_box(1);
  Cloud one, planar, nan, same;
  one.points = {{0, 0, 1}};
  for (int i = 0; i < 100; ++i)
    for (int j = 0; j < 100; ++j) planar.points.emplace_back(0.03F * i, 0.03F * j, 2.0F);
  nan.points.assign(1000, Eigen::Vector3f(NAN, NAN, NAN));
  same.points.assign(100000, Eigen::Vector3f(1, 1, 1));
  for (const Cloud& bad : {Cloud{}, one, nan, same}) {
    EXPECT_FALSE(align_clouds(bad, good, {}));
    EXPECT_FALSE(align_clouds(good, bad, {}));
  }
  const auto flat = align_clouds(planar, planar, {});
  EXPECT_TRUE(!flat || !flat->trusted) << "a plane slides on itself";
  AlignOptions options;
  options.voxel_size_m = 0;
  EXPECT_FALSE(align_clouds(good, good, options));
}

TEST(Align, CloudsFarFromTheirOriginAreErrorsAndASinglePointThereIsNot) {
  const Cloud good = two_walls_and_a_box(1);
  Cloud far = good, one_far = good;
  for (Eigen::Vector3f& p : far.points) p.x() += 1e6F;
  one_far.points.emplace_back(1e7F, 1e7F, 1e7F);
  const auto result = align_clouds(far, good, {});
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("source"), std::string::npos) << result.error().message;
  EXPECT_TRUE(align_clouds(one_far, good, {}));
}

TEST(Describe, ACloudOfAnySizeGivesABoundedNumberOfDescriptors) {
  const Cloud cloud = with_normals(voxel_downsample(two_walls_and_a_box(1), 0.05), Eigen::Vector3f::Zero());
  const auto described = [&](std::size_t most) { return describe(cloud, {0.5, 1.0, 1, most}).features.size(); };
  ASSERT_GT(cloud.size(), 2000U);
  EXPECT_EQ(described(1'000'000), described(cloud.size()));
  EXPECT_NEAR(static_cast<double>(described(500)), 500, 100);
}

}  // namespace
}  // namespace liloc
