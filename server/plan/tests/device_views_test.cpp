#include "server/plan/device_views.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "server/plan/tests/scanned_room.hpp"

namespace liloc::plan {
namespace {

struct Looked {
  VoxelRoom room;
  FreeFloor floor;
  DeviceViews devices;
};

Looked look(const Cloud& scan) {
  VoxelRoom room = VoxelRoom::create(scan).value();
  FreeFloor floor = find_free_floor(room, test::few_places()).value();
  DeviceViews devices = look_around(room, floor, test::small_device(), [](double) {});
  return {std::move(room), std::move(floor), std::move(devices)};
}

TEST(DeviceViews, AreOfEveryPlaceHeightAndDirection) {
  const Looked l = look(test::scan_of_two_rooms());
  EXPECT_EQ(l.devices.views.size(), l.floor.places_map.size() * 2 * 8);
  EXPECT_EQ(l.devices.twins.size(), l.devices.views.size());
  for (const DeviceView& view : l.devices.views)
    EXPECT_LT((view.T_map_sensor.translation().head<2>().cast<float>() - l.floor.places_map[view.place]).norm(),
              1e-5F);
}

TEST(DeviceViews, ASurfaceKnowsItsViewers) {
  const Looked l = look(test::scan_of_two_rooms());
  std::size_t pairs = 0;
  for (Surface s = 0; s < l.room.surfaces(); ++s)
    for (std::uint32_t i = l.devices.viewers_of[s]; i < l.devices.viewers_of[s + 1]; ++i, ++pairs)
      ASSERT_TRUE(std::ranges::binary_search(l.devices.views[l.devices.viewers[i]].seen, s));
  std::size_t seen = 0;
  for (const DeviceView& view : l.devices.views) seen += view.seen.size();
  EXPECT_EQ(pairs, seen);
}

TEST(DeviceViews, ABareSquareRoomHasTwinsAndAFurnishedOneFewer) {
  Cloud bare;
  test::add_box(bare, {0, 0, 0}, {6, 6, 3});
  Cloud furnished = bare;
  test::add_box(furnished, {0.1, 1, 0}, {0.9, 3, 2});
  test::add_box(furnished, {4, 4.5, 0}, {5, 5.9, 1.2});
  test::add_box(furnished, {4, 0.1, 0}, {4.8, 0.9, 1});
  const auto mean = [](const DeviceViews& devices) {
    double sum = 0;
    for (const Twin& twin : devices.twins) sum += twin.alike;
    return sum / static_cast<double>(devices.twins.size());
  };
  const Looked without = look(bare), with = look(furnished);
  EXPECT_GT(mean(without.devices), 0.97);
  EXPECT_LT(mean(with.devices), mean(without.devices) - 0.05);
}

TEST(DeviceViews, ATwinIsSomewhereElse) {
  const Looked l = look(test::scan_of_two_rooms());
  for (std::size_t i = 0; i < l.devices.views.size(); ++i) {
    const DeviceView &a = l.devices.views[i], &b = l.devices.views[l.devices.twins[i].view];
    EXPECT_TRUE(distance_m(a.T_map_sensor, b.T_map_sensor) > 0.99 ||
                angle_between_rad(a.T_map_sensor, b.T_map_sensor) > 1);
  }
}

TEST(Looking, LooksWhereItIsTold) {
  const Pose T = looking({1, 2, 3}, 0.5, 0.3);
  EXPECT_NEAR((T.linear() * T.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 0, 1e-12);
  EXPECT_NEAR(T.linear().determinant(), 1, 1e-12);
  EXPECT_NEAR(std::atan2(T(1, 2), T(0, 2)), 0.5, 1e-12);
  EXPECT_NEAR(T(2, 2), -std::sin(0.3), 1e-12);
  EXPECT_LT(T(2, 1), 0) << "the image's y is down";
}

}  // namespace
}  // namespace liloc::plan
