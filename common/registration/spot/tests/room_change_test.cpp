#include <gtest/gtest.h>

#include <random>

#include "common/registration/points/cloud_change.hpp"
#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

class RoomChangeLaw : public testing::TestWithParam<unsigned> {};

/// Takes points away here, moves some there, adds others, and lets two change places.
Cloud changed(const Cloud& cloud, std::mt19937_64& rng) {
  std::uniform_real_distribution<float> unit(-1, 1);
  const auto near = [&] { return cloud.points[rng() % cloud.size()]; };
  const Eigen::Vector3f gone = near(), moved = near(), fresh = near();
  Cloud now;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    if ((cloud.points[i] - gone).norm() < 0.4F) continue;
    const bool moves = (cloud.points[i] - moved).norm() < 0.3F;
    now.points.emplace_back(cloud.points[i] + (moves ? 0.03F : 0.0F) * cloud.normals[i]);
    now.normals.push_back(cloud.normals[i]);
    if (i % 97 != 0) continue;
    now.points.emplace_back(fresh + 0.3F * Eigen::Vector3f(unit(rng), unit(rng), unit(rng)));
    now.normals.push_back(Eigen::Vector3f(unit(rng), unit(rng), unit(rng)).normalized());
  }
  const std::size_t i = rng() % now.size(), k = rng() % now.size();
  std::swap(now.points[i], now.points[k]);
  std::swap(now.normals[i], now.normals[k]);
  return now;
}

void expect_same(const NearestGrid& a, const NearestGrid& b, const Eigen::AlignedBox3f& box, float step) {
  std::size_t found = 0, different = 0;
  for (float z = box.min().z(); z < box.max().z(); z += step)
    for (float y = box.min().y(); y < box.max().y(); y += step)
      for (float x = box.min().x(); x < box.max().x(); x += step) {
        found += a.nearest({x, y, z}) != NearestGrid::kNone;
        different += a.nearest({x, y, z}) != b.nearest({x, y, z});
      }
  EXPECT_EQ(different, 0U);
  EXPECT_GT(found, 1000U);
}

void expect_same(const ScoreField& a, const ScoreField& b) {
  ASSERT_EQ(a.size(), b.size());
  ASSERT_EQ(a.origin(), b.origin());
  std::size_t different = 0, free = 0, surfaces = 0;
  for (int plane = 0; plane <= ScoreField::kAny; ++plane)
    for (int z = 0; z < a.size().z(); ++z)
      for (int y = 0; y < a.size().y(); ++y)
        for (int x = 0; x < a.size().x(); ++x) {
          different += a.row(y, z, plane)[x] != b.row(y, z, plane)[x];
          free += a.row(y, z, plane)[x] < 0;
          surfaces += a.row(y, z, plane)[x] > 0;
        }
  EXPECT_EQ(different, 0U);
  EXPECT_GT(free, 1000U);
  EXPECT_GT(surfaces, 1000U);
}

TEST_P(RoomChangeLaw, IndicesOfARoomThatChangedAreThoseOfARoomBuiltAnew) {
  const WatchedRoom w = watched_room(GetParam());
  const std::vector<SightView> others = watch(w.room, GetParam() + 100).views;  // the same sensors, other noise
  std::mt19937_64 rng(GetParam());
  auto before = std::make_shared<const Surfaces>(w.target->cloud, w.target.views, 0.05);
  (void)before->field_fine();
  Cloud cloud = w.target->cloud;
  for (int round = 0; round < 5; ++round) {
    cloud = changed(cloud, rng);
    std::vector<SightView> views = w.target.views;
    for (SightView& view : views)
      if (rng() % 2 == 0) view = others[static_cast<std::size_t>(&view - views.data())];
    if (round == 3) views.pop_back();  // a sensor falls silent
    const auto now = std::make_shared<const Surfaces>(cloud, views, 0.05, before.get());
    const Surfaces anew(cloud, views, 0.05);
    Eigen::AlignedBox3f box;
    for (const Eigen::Vector3f& p : cloud.points) box.extend(p);
    box.min().array() -= 0.5F;
    box.max().array() += 0.5F;
    expect_same(now->nearest, anew.nearest, box, 0.04F);
    expect_same(now->nearest_coarse, anew.nearest_coarse, box, 0.07F);
    expect_same(now->field_coarse(), anew.field_coarse());
    expect_same(now->field_fine(), anew.field_fine());
    before = now;
  }
}

TEST_P(RoomChangeLaw, PointsThatStayAreToldFromTheOthers) {
  const Cloud before = watched_room(GetParam()).target->cloud;
  std::mt19937_64 rng(GetParam());
  const Cloud now = changed(before, rng);
  const CloudChange change = change_between(before, now);
  std::vector<bool> known(now.size(), false);
  std::int32_t last = -1;
  std::size_t gone = 0;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const std::int32_t k = change.now[i];
    gone += k == CloudChange::kGone;
    if (k == CloudChange::kGone) continue;
    ASSERT_GT(k, last);
    last = k;
    ASSERT_EQ(now.points[static_cast<std::size_t>(k)], before.points[i]);
    ASSERT_EQ(now.normals[static_cast<std::size_t>(k)], before.normals[i]);
    known[static_cast<std::size_t>(k)] = true;
  }
  EXPECT_EQ(change.gone.size(), gone);
  for (const std::uint32_t i : change.fresh) {
    ASSERT_FALSE(known[i]);
    known[i] = true;
  }
  EXPECT_EQ(std::ranges::count(known, false), 0) << "each point either stayed or is fresh";
  EXPECT_LT(change.fresh.size(), now.size() / 3);
  EXPECT_GT(gone, 10U);
}

TEST_P(RoomChangeLaw, ARoomThatDidNotChangeHasNoChange) {
  const Cloud cloud = watched_room(GetParam()).target->cloud;
  const CloudChange change = change_between(cloud, cloud);
  EXPECT_TRUE(change.fresh.empty());
  EXPECT_TRUE(change.gone.empty());
}

TEST_P(RoomChangeLaw, CountsOfSpaceThatIsLookedThroughAreWhatEachLookSays) {
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

INSTANTIATE_TEST_SUITE_P(Seeds, RoomChangeLaw, testing::Range(1U, 5U));

}  // namespace
}  // namespace liloc
