#include "common/registration/sight/sight.hpp"

#include <gtest/gtest.h>

#include <random>

#include "common/registration/spot/judge.hpp"
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

TEST(Sight, RunsThatArePassedOverHoldNothingInView) {
  for (const unsigned seed : {1U, 2U, 3U}) {
    const WatchedRoom w = watched_room(seed);
    const std::vector<Eigen::Vector3f>& all = w.target->coarse.points;
    std::vector<Eigen::Vector3f> sound, stale, every_other;
    for (std::size_t i = 0; i < all.size(); ++i) {
      (i % 7 == 0 ? stale : sound).push_back(all[i]);
      if (i % 2 == 0) every_other.push_back(all[i]);
    }
    const auto count = [&](const std::vector<Eigen::Vector3f>& points, const Eigen::Isometry3f& T) {
      return w.query.view.tally(Vectors(points).run(0, points.size()), T, 0.05F);
    };
    std::mt19937_64 rng(seed);
    std::uniform_real_distribution<double> unit(-1, 1);
    int agree = 0;
    for (int trial = 0; trial < 50; ++trial) {
      Pose T_map_device = w.T_map_device;
      T_map_device.linear() =
          so3_exp(3 * Eigen::Vector3d(unit(rng), unit(rng), unit(rng))) * T_map_device.linear();
      T_map_device.translation() += 2 * Eigen::Vector3d(unit(rng), unit(rng), unit(rng));
      const Eigen::Isometry3f T = T_map_device.inverse().cast<float>();
      const SightView::Tally in_doubt = MapPoints(sound, stale).seen_by(w.query.view, T, 0.05F, MapShare::all),
                             half = MapPoints(all).seen_by(w.query.view, T, 0.05F, MapShare::half);
      EXPECT_EQ(in_doubt.agree, count(all, T).agree);
      EXPECT_EQ(in_doubt.conflict, count(sound, T).conflict);
      EXPECT_EQ(half.agree, count(every_other, T).agree);
      EXPECT_EQ(half.conflict, count(every_other, T).conflict);
      agree += half.agree;
    }
    EXPECT_GT(agree, 100);
  }
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

class JudgeLaw : public testing::TestWithParam<unsigned> {};

TEST_P(JudgeLaw, TheTruthConflictsWithNothing) {
  const WatchedRoom w = watched_room(GetParam());
  const Judgement j = judge(w.target, w.query, w.query.medium, w.T_map_device, 0.05);
  EXPECT_LT(j.conflict, 0.02);
  EXPECT_LT(j.map_conflict, 0.03);
  EXPECT_GT(j.overlap(), 0.95);
}

TEST_P(JudgeLaw, NoPoseFarFromTheTruthScoresHigher) {
  const WatchedRoom w = watched_room(GetParam());
  const double truth = judge(w.target, w.query, w.query.medium, w.T_map_device, 0.05).score;
  for (int yaw = 1; yaw < 8; ++yaw)
    for (const double shift : {0.0, 0.8}) {
      Pose wrong = scene::looking(w.T_map_device.translation() + Eigen::Vector3d(shift, -shift, 0),
                                  0.9 * GetParam() + yaw * M_PI / 4, radians(12));
      EXPECT_LT(judge(w.target, w.query, w.query.medium, wrong, 0.05).score, truth) << yaw << " " << shift;
    }
}

INSTANTIATE_TEST_SUITE_P(Seeds, JudgeLaw, testing::Range(1U, 9U));

}  // namespace
}  // namespace liloc
