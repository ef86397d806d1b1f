#include "common/registration/sight/sight.hpp"

#include <gtest/gtest.h>

#include <random>

#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

const Camera kCamera{64, 48, 50.0, 50.0, 31.5, 23.5, 0.001};

/// A wall at 3 m with a box at 1.5 m before its left half.
SightView half_covered() {
  DepthImage image{0, 64, 48, std::vector<std::uint16_t>(64 * 48, 3000)};
  for (int v = 0; v < 48; ++v)
    for (int u = 0; u < 32; ++u) image.units[static_cast<std::size_t>(v * 64 + u)] = 1500;
  image.units[64 * 47 + 63] = 0;
  return SightView::from_depth(image, kCamera, Pose::Identity(), 1, 8.5);
}

TEST(Sight, SaysWhatALineOfSightShows) {
  const SightView view = half_covered();
  EXPECT_EQ(view.look({0.5F, 0, 3.0F}, 0.05F), Sight::agrees);
  EXPECT_EQ(view.look({0.5F, 0, 2.0F}, 0.05F), Sight::conflict) << "before the wall, and the wall was seen";
  EXPECT_EQ(view.look({-0.5F, 0, 2.0F}, 0.05F), Sight::behind) << "hidden by the box";
  EXPECT_EQ(view.look({-0.4F, 0, 1.0F}, 0.05F), Sight::conflict);
  EXPECT_EQ(view.look({0, 0, -1.0F}, 0.05F), Sight::unseen) << "behind the sensor";
  EXPECT_EQ(view.look({10, 0, 1.0F}, 0.05F), Sight::unseen) << "outside the view";
}

TEST(Sight, BesideAnEdgeNothingConflicts) {
  // One pixel right of the box's edge: a point at the box's depth may belong to the box.
  EXPECT_NE(half_covered().look({0.5F / 50 * 1.5F, 0, 1.5F}, 0.05F), Sight::conflict);
}

TEST(Sight, ReachesWhatItMayLookThroughAndNothingFarAway) {
  const SightView view = half_covered();
  EXPECT_TRUE(view.reaches({Eigen::Vector3f(-0.1F, -0.1F, 1), Eigen::Vector3f(0.1F, 0.1F, 1.2F)}));
  EXPECT_TRUE(view.reaches({Eigen::Vector3f(1.7F, 1.2F, 2.8F), Eigen::Vector3f(9, 9, 9)})) << "a corner of it";
  EXPECT_FALSE(view.reaches({Eigen::Vector3f(-1, -1, 5), Eigen::Vector3f(1, 1, 6)}));
  EXPECT_FALSE(view.reaches({Eigen::Vector3f(100, 0, 0), Eigen::Vector3f(120, 10, 3)}));
  EXPECT_FALSE(SightView().reaches({Eigen::Vector3f(-1, -1, -1), Eigen::Vector3f(1, 1, 1)}));
}

TEST(Sight, BesideAnEdgeOfADevicesCloudNothingConflicts) {
  Cloud cloud;  // a box at 1.5 m up to x = 0 and a wall at 3 m, in voxels of 0.05 m
  for (float y = -0.6F; y < 0.6F; y += 0.05F) {
    for (float x = -0.475F; x < 0; x += 0.05F) cloud.points.emplace_back(x, y, 1.5F);
    for (float x = -1.0F; x < 1.0F; x += 0.05F)
      if (x > 0.02F) cloud.points.emplace_back(x, y * 2, 3.0F);
  }
  const SightView view = SightView::from_cloud(cloud, kCamera, 0.05, 64);
  EXPECT_EQ(view.look_sensor({0.1F, 0.0F, 3.0F}, 0.05F), Sight::agrees) << "the wall beside the box";
  EXPECT_EQ(view.look_sensor({0.04F, 0.0F, 1.5F}, 0.05F), Sight::unseen) << "the box reaches that far, or not";
  EXPECT_EQ(view.look_sensor({0.15F, 0.0F, 1.5F}, 0.05F), Sight::conflict) << "there the wall is seen";
  EXPECT_EQ(view.look_sensor({0.04F, 0.0F, 1.2F}, 0.05F), Sight::conflict) << "before both";
}

TEST(Sight, ManyPointsAreCountedAsEachIsSeen) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const WatchedRoom w = watched_room(seed);
    const Eigen::Isometry3f T = w.T_map_device.inverse().cast<float>();
    const std::size_t count = w.target->coarse.size() - 5;
    int agree = 0, conflict = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Sight sight = w.query.view.look_sensor(T * w.target->coarse.points[i], 0.05F);
      agree += sight == Sight::agrees;
      conflict += sight == Sight::conflict;
    }
    const Vectors points(w.target->coarse.points);
    const SightView::Tally tally = w.query.view.tally(points.run(0, count), T, 0.05F);
    ASSERT_GT(agree, 100);
    EXPECT_LE(std::abs(tally.agree - agree), 2) << "of those on the edge of a pixel";
    EXPECT_LE(std::abs(tally.conflict - conflict), 2);
  }
}

TEST(Sight, AViewRebuiltFromTheCloudAgreesWithItsOwnPoints) {
  const WatchedRoom w = watched_room(3);
  std::size_t agree = 0, conflict = 0;
  for (const auto& p : w.query.cloud.points) {
    const Sight sight = w.query.view.look_sensor(p, 0.05F);
    agree += sight == Sight::agrees;
    conflict += sight == Sight::conflict;
  }
  EXPECT_GT(agree, w.query.cloud.size() * 9 / 10);
  EXPECT_LT(conflict, w.query.cloud.size() / 50);
}

TEST(Sight, OfManySensorsOneThatMeasuredOutweighsOneThatLookedBy) {
  const SightView view = half_covered();
  const Vectors points({{0.5F, 0, 3.0F}, {0.5F, 0, 2.0F}, {-0.5F, 0, 2.0F}, {10, 0, 1.0F}});
  std::vector<std::int32_t> words{kNoWord, kNoWord, kNoWord, kLookedThrough};
  view.look_at_all(points.run(0, 4), 0.05F, words.data());
  EXPECT_EQ(words, (std::vector<std::int32_t>{kMeasured, kLookedThrough, kNoWord, kLookedThrough}));
  words.assign(4, kMeasured);
  view.look_at_all(points.run(0, 4), 0.05F, words.data());
  EXPECT_EQ(words, std::vector<std::int32_t>(4, kMeasured));
}

class SightLaw : public testing::TestWithParam<unsigned> {};

TEST_P(SightLaw, CountsOfSpaceThatIsLookedThroughAreWhatEachLookSays) {
  const WatchedRoom w = watched_room(GetParam());
  const SightView now = watch(w.room, GetParam() + 100).views[0], &before = w.target.views[0];
  std::mt19937_64 rng(GetParam());
  std::uniform_real_distribution<float> unit(-1, 7);
  Vectors points(1300);
  for (std::size_t i = 0; i < 1300; ++i) points.set(i, {unit(rng), unit(rng), unit(rng) / 2});
  std::vector<std::uint8_t> counts(1300, 0), first(1300, 0);
  before.count_through(points.run(0, 1300), 0.08F, nullptr, counts.data());
  first = counts;
  now.count_through(points.run(0, 1300), 0.08F, &before, counts.data());
  int differ = 0, through = 0;
  for (std::size_t i = 0; i < 1300; ++i) {
    const Eigen::Vector3f p(points.x[i], points.y[i], points.z[i]);
    through += first[i];
    differ += first[i] != (before.look(p, 0.08F) == Sight::conflict ? 1 : 0);
    differ += counts[i] != (now.look(p, 0.08F) == Sight::conflict ? 1 : 0);
  }
  EXPECT_GT(through, 50);
  EXPECT_LE(differ, 2) << "but for rounding at the rim of a pixel";
}

INSTANTIATE_TEST_SUITE_P(Seeds, SightLaw, testing::Range(1U, 5U));

}  // namespace
}  // namespace liloc
