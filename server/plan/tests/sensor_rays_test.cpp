#include "server/plan/sensor_rays.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "server/plan/tests/scanned_room.hpp"

namespace liloc::plan {
namespace {

const VoxelRoom& room() {
  static const VoxelRoom built = VoxelRoom::create(test::scan_of_two_rooms()).value();
  return built;
}

TEST(SensorRays, SeesWhatIsBeforeItAndNothingBehindAWall) {
  const SensorRays rays(scene::small_camera(), 8.5);
  const auto seen = rays.seen(room(), looking({1, 4, 1.5}, 0, 0));
  ASSERT_GT(seen.size(), 200U);
  EXPECT_TRUE(std::ranges::is_sorted(seen));
  EXPECT_EQ(std::ranges::adjacent_find(seen), seen.end());
  EXPECT_EQ(seen.capacity(), seen.size()) << "many views are kept at once";
  for (const Surface s : seen) EXPECT_LT(room().point_map(s).x(), 4.55F);
}

TEST(SensorRays, SeesNoFartherThanItsRange) {
  for (const Surface s : SensorRays(scene::small_camera(), 2).seen(room(), looking({1, 4, 1.5}, 0, 0)))
    EXPECT_LT((room().point_map(s) - Eigen::Vector3f(1, 4, 1.5F)).norm(), 2.1F);
}

TEST(SensorRays, SidesThatAreMetFaceTheSensor) {
  const Eigen::Vector3f from(3, 1.5F, 2.5F);
  for (const Surface s :
       SensorRays(scene::small_camera(), 8.5).seen(room(), looking(from.cast<double>(), 2, 0.6)))
    EXPECT_GT(room().normal_map(s).dot(from - room().point_map(s)), -0.1F);  // its voxel's middle, not the hit
}

TEST(SensorRays, FineCamerasCostNoMoreThanVoxelsAsk) {
  Camera fine = scene::small_camera();
  fine.width *= 8;
  fine.height *= 8;
  fine.fx *= 8;
  fine.fy *= 8;
  fine.cx = 8 * fine.cx + 3.5;
  fine.cy = 8 * fine.cy + 3.5;
  EXPECT_LT(SensorRays(fine, 6).size(), 6000U);
  EXPECT_NEAR(static_cast<double>(SensorRays(fine, 6).size()),
              static_cast<double>(SensorRays(scene::small_camera(), 6).size()), 1);
}

TEST(SensorRays, RangesAreOfTheWholeView) {
  const SensorRays rays(scene::small_camera(), 6);
  const auto ranges = rays.ranges(room(), looking({1, 4, 1.5}, 0, 0));
  ASSERT_EQ(ranges.size(), static_cast<std::size_t>(SensorRays::kGridColumns * SensorRays::kGridRows));
  EXPECT_NEAR(ranges[6 * SensorRays::kGridColumns + 8], 3.4, 0.2);
  EXPECT_LE(*std::ranges::max_element(ranges), 6);
}

}  // namespace
}  // namespace liloc::plan
