#include "server/plan/free_floor.hpp"

#include <gmock/gmock.h>

#include "server/plan/tests/scanned_room.hpp"

namespace liloc::plan {
namespace {

using testing::HasSubstr;

TEST(FreeFloor, IsWhereABodyFits) {
  const VoxelRoom room = VoxelRoom::create(test::scan_of_two_rooms()).value();
  const FreeFloor floor = find_free_floor(room).value();
  EXPECT_NEAR(floor.floor_z_m, 0, 0.1);
  ASSERT_TRUE(floor.ceiling_z_m);
  EXPECT_NEAR(*floor.ceiling_z_m, 3, 0.1);
  EXPECT_GT(floor.area_m2, 25);
  EXPECT_LT(floor.area_m2, 40);
  EXPECT_GT(floor.places_map.size(), 60U);
  for (const Eigen::Vector2f& p : floor.places_map) {
    EXPECT_FALSE(p.x() > 0.8 && p.x() < 2.4 && p.y() > 1.8 && p.y() < 3.2) << "on the table";
    EXPECT_FALSE(std::abs(p.x() - 4.5) < 0.3 && p.y() > 1) << "in the wall";
    EXPECT_TRUE(p.x() > 0.2 && p.x() < 7.8 && p.y() > 0.2 && p.y() < 5.8) << p.transpose();
  }
}

TEST(FreeFloor, PlacesAreNoMoreThanAsked) {
  const VoxelRoom room = VoxelRoom::create(test::scan_of_two_rooms()).value();
  const FreeFloor floor = find_free_floor(room, test::few_places()).value();
  EXPECT_LE(floor.places_map.size(), 30U);  // about: the grid is of whole voxels
  EXPECT_GE(floor.places_map.size(), 15U);
}

TEST(FreeFloor, ARoomWithoutACeilingHasNone) {
  Cloud scan = test::scan_of_two_rooms();
  std::erase_if(scan.points, [](const Eigen::Vector3f& p) { return p.z() > 2.5F; });
  EXPECT_FALSE(find_free_floor(VoxelRoom::create(scan).value()).value().ceiling_z_m);
}

TEST(FreeFloor, ARoomWithoutAFloorIsNamed) {
  Cloud scan = test::scan_of_two_rooms();
  std::erase_if(scan.points, [](const Eigen::Vector3f& p) { return p.z() < 0.5F || p.z() > 2.5F; });
  EXPECT_THAT(find_free_floor(VoxelRoom::create(scan).value()).error().message, HasSubstr("is z up"));
}

TEST(FreeFloor, ACrammedRoomIsNamed) {
  Cloud scan = test::scan_of_two_rooms();
  for (int i = 0; i < 16; ++i) test::add_box(scan, {0.5 * i, 0, 0}, {0.5 * i + 0.3, 6, 1});
  EXPECT_THAT(find_free_floor(VoxelRoom::create(scan).value()).error().message, HasSubstr("free to stand on"));
}

}  // namespace
}  // namespace liloc::plan
