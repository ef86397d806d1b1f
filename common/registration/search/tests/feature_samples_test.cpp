#include "common/registration/search/feature_samples.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

/// Matches of the device's points with the room, a third of them right.
std::vector<FeatureMatch> a_third_right(const WatchedRoom& w, unsigned seed) {
  std::mt19937_64 rng(seed);
  const Cloud& points = w.query.medium;
  const Cloud placed = transformed(w.T_map_device, points);
  std::vector<FeatureMatch> matches;
  for (std::size_t i = 0; i < points.size(); i += 2) {
    const std::size_t k = rng() % 3 == 0 ? i : rng() % points.size();
    matches.push_back({points.points[i], placed.points[k], points.normals[i], placed.normals[k]});
  }
  return matches;
}

bool right(const WatchedRoom& w, const Candidate& c) {
  return distance_m(c.T_map_sensor, w.T_map_device) < 0.15 &&
         degrees(angle_between_rad(c.T_map_sensor, w.T_map_device)) < 5;
}

class FeatureSamplesLaw : public testing::TestWithParam<unsigned> {};

TEST_P(FeatureSamplesLaw, AThirdOfTheMatchesIsEnoughForTheBestSample) {
  const WatchedRoom w = watched_room(GetParam());
  const std::vector<FeatureMatch> matches = a_third_right(w, GetParam());
  for (const Sample sample : {Sample::three_points, Sample::two_normals}) {
    SampleOptions options;
    options.sample = sample;
    options.iterations = 20000;
    const auto found = sample_poses(w.target->field_fine(), w.query.sparse.points, matches, options);
    ASSERT_FALSE(found.empty());
    EXPECT_LE(found.size(), options.keep);
    EXPECT_TRUE(right(w, *std::ranges::max_element(found, {}, &Candidate::score)));
  }
}

TEST_P(FeatureSamplesLaw, ASeedGivesTheSameAndKeepingFewerKeepsTheBest) {
  const WatchedRoom w = watched_room(GetParam());
  const std::vector<FeatureMatch> matches = a_third_right(w, GetParam());
  const auto best_of = [&](std::size_t keep) {
    SampleOptions options;
    options.keep = keep;
    options.iterations = 5000;
    const auto found = sample_poses(w.target->field_fine(), w.query.sparse.points, matches, options);
    EXPECT_LE(found.size(), keep);
    return *std::ranges::max_element(found, {}, &Candidate::score);
  };
  const Candidate once = best_of(24), again = best_of(24), alone = best_of(1);
  EXPECT_EQ(once.score, again.score);
  EXPECT_EQ(once.T_map_sensor.matrix(), again.T_map_sensor.matrix());
  EXPECT_EQ(once.score, alone.score);
}

TEST_P(FeatureSamplesLaw, WrongMatchesAloneFindNothingAsGood) {
  const WatchedRoom w = watched_room(GetParam());
  const std::vector<FeatureMatch> matches = a_third_right(w, GetParam());
  std::vector<FeatureMatch> wrong = matches;
  std::erase_if(wrong, [&](const FeatureMatch& m) {
    return (w.T_map_device.cast<float>() * m.source - m.target).norm() < 0.5F;
  });
  SampleOptions options;
  options.iterations = 20000;
  const auto best = [&](const std::vector<FeatureMatch>& of) {
    double most = 0;
    for (const Candidate& c : sample_poses(w.target->field_fine(), w.query.sparse.points, of, options))
      most = std::max(most, c.score);
    return most;
  };
  EXPECT_LT(best(wrong), best(matches));
}

INSTANTIATE_TEST_SUITE_P(Seeds, FeatureSamplesLaw, testing::Range(1U, 5U));

TEST(FeatureSamples, TwoMatchesGiveNoPose) {
  const WatchedRoom w = watched_room(1);
  std::vector<FeatureMatch> matches = a_third_right(w, 1);
  matches.resize(2);
  EXPECT_TRUE(sample_poses(w.target->field_fine(), w.query.sparse.points, matches, {}).empty());
  EXPECT_TRUE(sample_poses(w.target->field_fine(), w.query.sparse.points, {}, {}).empty());
}

}  // namespace
}  // namespace liloc
