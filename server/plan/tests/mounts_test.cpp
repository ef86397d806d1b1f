#include "server/plan/mounts.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "server/plan/tests/scanned_room.hpp"

namespace liloc::plan {
namespace {

struct Rooms {
  VoxelRoom room = VoxelRoom::create(test::scan_of_two_rooms()).value();
  FreeFloor floor = find_free_floor(room, test::few_places()).value();
  MountOptions options = [] {
    MountOptions o;
    o.ceiling_z_m = 3;
    return o;
  }();
};

TEST(Mounts, HangInFreeSpaceUnderTheCeilingAndOffTheWalls) {
  const Rooms r;
  const auto mounts = possible_mounts(r.room, r.floor, r.options);
  ASSERT_GT(mounts.size(), 200U);
  for (const Mount& mount : mounts) {
    EXPECT_FALSE(r.room.occupied(mount.at_map.cast<float>()));
    EXPECT_GT(mount.at_map.x(), 0.15);
    EXPECT_LT(mount.at_map.x(), 7.85);
    EXPECT_GE(mount.at_map.z(), 2.2);
    EXPECT_LT(mount.at_map.z(), 3);
    EXPECT_TRUE(std::abs(mount.at_map.x() - 4.5) > 0.2 || mount.at_map.y() < 1) << mount.at_map.transpose();
  }
}

TEST(Mounts, DoNotLookAtTheWallBehindThem) {
  const Rooms r;
  for (const Mount& mount : possible_mounts(r.room, r.floor, r.options)) {
    const Eigen::Vector3f direction(static_cast<float>(std::cos(mount.azimuth_rad)),
                                    static_cast<float>(std::sin(mount.azimuth_rad)), 0);
    EXPECT_FALSE(r.room.first_hit(mount.at_map.cast<float>(), direction, 1.4F));
  }
}

TEST(Mounts, AreNoMoreThanAskedAndTheSameForASeed) {
  Rooms r;
  r.options.most = 100;
  const auto first = possible_mounts(r.room, r.floor, r.options),
             again = possible_mounts(r.room, r.floor, r.options);
  ASSERT_EQ(first.size(), 100U);
  for (std::size_t i = 0; i < first.size(); ++i) EXPECT_EQ(first[i].at_map, again[i].at_map);
  r.options.seed = 2;
  EXPECT_NE(possible_mounts(r.room, r.floor, r.options).front().at_map, first.front().at_map);
}

TEST(Mounts, OutsideAndInsideOfThingsNothingHangs) {
  const Rooms r;
  EXPECT_TRUE(can_hang(r.room, r.floor, {2, 4, 2.8}, 0.3));
  EXPECT_FALSE(can_hang(r.room, r.floor, {2, 4, 3.5}, 0.3)) << "above the ceiling";
  EXPECT_FALSE(can_hang(r.room, r.floor, {-1, 4, 2.8}, 0.3)) << "outside";
  EXPECT_FALSE(can_hang(r.room, r.floor, {0.25, 4, 2.8}, 0.3)) << "in the wall's reach";
}

}  // namespace
}  // namespace liloc::plan
