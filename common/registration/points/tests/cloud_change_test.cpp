#include "common/registration/points/cloud_change.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "common/testing/changed_room.hpp"
#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

class CloudChangeLaw : public testing::TestWithParam<unsigned> {};

TEST_P(CloudChangeLaw, PointsThatStayAreToldFromTheOthers) {
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

TEST_P(CloudChangeLaw, ARoomThatDidNotChangeHasNoChange) {
  const Cloud cloud = watched_room(GetParam()).target->cloud;
  const CloudChange change = change_between(cloud, cloud);
  EXPECT_TRUE(change.fresh.empty());
  EXPECT_TRUE(change.gone.empty());
}

INSTANTIATE_TEST_SUITE_P(Seeds, CloudChangeLaw, testing::Range(1U, 5U));

}  // namespace
}  // namespace liloc
