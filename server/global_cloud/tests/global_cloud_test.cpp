#include "server/global_cloud/global_cloud.hpp"

#include <gmock/gmock.h>

#include <deque>
#include <set>
#include <thread>

namespace liloc {
namespace {

const Camera kCamera{32, 24, 25.0, 25.0, 15.5, 11.5, 0.001};

Site two_lidars() {
  Site site;
  for (const char* id : {"a", "b"}) site.global_lidars.push_back({id, kCamera, 8.0, Pose::Identity()});
  site.global_lidars[1].T_map_sensor.translation().x() = 0.01;
  return site;
}

DepthImage wall(StampNs stamp_ns, std::uint16_t units = 2000) {
  return {stamp_ns, 32, 24, std::vector<std::uint16_t>(32 * 24, units)};
}

constexpr StampNs kT0 = 1'700'000'000'000'000'000;

TEST(GlobalCloud, MatchesTheNearestFramesWithin100Ms) {
  GlobalCloud cloud(two_lidars(), {});
  for (int i = 0; i < 8; ++i) {
    ASSERT_TRUE(cloud.add_depth(0, wall(kT0 + from_ms(125 * i))));
    ASSERT_TRUE(cloud.add_depth(1, wall(kT0 + from_ms(125 * i + 30))));
  }
  const auto snapshot = cloud.nearest(kT0 + from_ms(260));
  ASSERT_TRUE(snapshot);
  EXPECT_EQ((*snapshot)->frames().size(), 2U);
  EXPECT_EQ((*snapshot)->stamp_near(kT0 + from_ms(260)), kT0 + from_ms(250));
  EXPECT_EQ(*cloud.nearest(kT0 + from_ms(262)), *snapshot) << "the same frames are the same snapshot";
  EXPECT_EQ((*cloud.nearest(kT0 + from_ms(400)))->room(), (*snapshot)->room())
      << "nothing moved: the same room";
  EXPECT_THAT(cloud.nearest(kT0 + from_ms(2000)).error().message, testing::HasSubstr("within 100 ms"));
}

TEST(GlobalCloud, TheNewestSnapshotHasEachLidarsNewestFrameUnlessItFellSilent) {
  GlobalCloud cloud(two_lidars(), {});
  EXPECT_EQ(cloud.newest(), nullptr);
  ASSERT_TRUE(cloud.add_depth(0, wall(kT0)));
  ASSERT_TRUE(cloud.add_depth(1, wall(kT0 + from_ms(50))));
  ASSERT_TRUE(cloud.add_depth(0, wall(kT0 + from_ms(100))));
  const auto both = cloud.newest();
  ASSERT_EQ(both->frames().size(), 2U);
  EXPECT_EQ(both->frames()[0]->stamp_ns(), kT0 + from_ms(100));
  EXPECT_EQ(cloud.newest(), both) << "the same frames are the same snapshot";
  EXPECT_FALSE(both->has_target()) << "nothing is built for whoever only looks";
  ASSERT_TRUE(cloud.add_depth(0, wall(kT0 + from_ms(1000))));
  EXPECT_EQ(cloud.newest()->frames().size(), 1U);
}

TEST(GlobalCloud, TheNewestSnapshotIsBuiltBeforeAnyoneAsks) {
  GlobalCloud cloud(two_lidars(), {});
  const auto frame = [&](std::size_t lidar, int at_ms) {
    ASSERT_TRUE(cloud.add_depth(lidar, wall(kT0 + from_ms(at_ms))));
  };
  frame(0, 0);
  frame(1, 30);
  cloud.prepare();
  EXPECT_TRUE((*cloud.nearest(kT0 + from_ms(40)))->has_target());
  frame(0, 125);
  EXPECT_FALSE((*cloud.nearest(kT0 + from_ms(110)))->has_target()) << "a newer frame is another moment";
  cloud.prepare();
  EXPECT_TRUE((*cloud.nearest(kT0 + from_ms(110)))->has_target());
}

TEST(GlobalCloud, DescriptorsAreMadeAheadOnceSomebodyNeedsThem) {
  GlobalCloud cloud(two_lidars(), {});
  const auto room_after = [&](int first, int last) {
    for (int i = first; i < last; ++i)
      for (const std::size_t lidar : {0U, 1U})
        EXPECT_TRUE(cloud.add_depth(lidar, wall(kT0 + from_ms(125 * i))));
    cloud.prepare();
    return *cloud.nearest(kT0 + from_ms(125 * (last - 1)));
  };
  const auto first = room_after(0, 2);
  EXPECT_FALSE(first->room()->has_descriptors()) << "nobody searches by features";
  (void)first->described();
  EXPECT_TRUE(first->room()->has_descriptors());
  const auto second = room_after(2, 4);  // the third frame renews the room
  EXPECT_NE(second->room(), first->room());
  EXPECT_TRUE(second->room()->has_descriptors());
}

TEST(GlobalCloud, ARoomIsIndexedAnewEvery100MsAtMost) {
  GlobalCloud cloud(two_lidars(), {});
  const auto at = [&](int ms, std::size_t lidar, std::uint16_t units) {
    EXPECT_TRUE(cloud.add_depth(lidar, wall(kT0 + from_ms(ms), units)));
    return (*cloud.nearest(kT0 + from_ms(ms)))->room();
  };
  at(0, 0, 2000);
  const auto first = at(10, 1, 2000);
  at(50, 0, 2500);
  at(60, 1, 2000);
  EXPECT_EQ(at(80, 0, 2500), first) << "the wall has gone, and lines of sight say so meanwhile";
  const auto second = at(115, 0, 2500);
  EXPECT_NE(second, first);
  EXPECT_EQ(second->parts().size(), 2U);
  EXPECT_EQ(at(200, 0, 2500)->parts().size(), 1U) << "LiDAR b is silent: its surfaces are not the room's";
}

TEST(GlobalCloud, RoomsThatSessionsHoldAreBounded) {
  GlobalCloud cloud(two_lidars(), {});
  std::deque<std::shared_ptr<const Snapshot>> held;  // of 4 s, as by sessions that look back five spots
  std::size_t most = 0;
  for (int i = 0; i < 200; ++i) {
    const auto units = static_cast<std::uint16_t>(2000 + 20 * i);  // farther each time: the room changes
    for (const std::size_t lidar : {0U, 1U})
      ASSERT_TRUE(cloud.add_depth(lidar, wall(kT0 + from_ms(50 * i), units)));
    held.push_back(*cloud.nearest(kT0 + from_ms(50 * i)));
    if (held.size() > 80) held.pop_front();
    std::set<const StitchedRoom*> rooms;
    for (const auto& snapshot : held) rooms.insert(snapshot->room().get());
    most = std::max(most, rooms.size());
  }
  EXPECT_GT(most, 8U);
  EXPECT_LT(most, 24U);
}

TEST(GlobalCloud, ASilentLidarIsLeftOut) {
  GlobalCloud cloud(two_lidars(), {});
  ASSERT_TRUE(cloud.add_depth(0, wall(kT0)));
  ASSERT_TRUE(cloud.add_depth(1, wall(kT0 - from_ms(500))));
  const auto snapshot = cloud.nearest(kT0);
  ASSERT_TRUE(snapshot);
  ASSERT_EQ((*snapshot)->frames().size(), 1U);
  EXPECT_EQ((*snapshot)->frames()[0]->lidar().id, "a");
}

TEST(GlobalCloud, BadFramesChangeNothing) {
  GlobalCloud cloud(two_lidars(), {});
  EXPECT_FALSE(cloud.nearest(kT0));
  EXPECT_FALSE(cloud.add_depth(2, wall(kT0)));
  DepthImage small = wall(kT0);
  small.width = 31;
  EXPECT_THAT(cloud.add_depth(0, small).error().message, testing::HasSubstr("31x24"));
  ASSERT_TRUE(cloud.add_depth(0, wall(kT0)));
  EXPECT_THAT(cloud.add_depth(0, wall(kT0)).error().message, testing::HasSubstr("not newer"));
  EXPECT_TRUE(cloud.nearest(kT0));
}

TEST(GlobalCloud, ALidarWhoseClockWasSetBackIsHeardAgain) {
  GlobalCloud cloud(two_lidars(), {});
  ASSERT_TRUE(cloud.add_depth(0, wall(kT0 + from_seconds(3600))));
  for (int i = 0; i < 2; ++i) EXPECT_FALSE(cloud.add_depth(0, wall(kT0 + from_ms(100 * i))));
  for (int i = 2; i < 5; ++i) EXPECT_TRUE(cloud.add_depth(0, wall(kT0 + from_ms(100 * i))));
  ASSERT_TRUE(cloud.nearest(kT0 + from_ms(400)));
  EXPECT_FALSE(cloud.nearest(kT0 + from_seconds(3600))) << "what it showed by the old clock is gone";
}

TEST(GlobalCloud, OneBadStampChangesNothing) {
  GlobalCloud cloud(two_lidars(), {});
  for (int i = 0; i < 6; ++i) {
    ASSERT_TRUE(cloud.add_depth(0, wall(kT0 + from_ms(100 * i))));
    EXPECT_FALSE(cloud.add_depth(0, wall(from_ms(100 * i)))) << "a driver that now and then forgets the time";
    EXPECT_TRUE(cloud.nearest(kT0 + from_ms(100 * i)));
  }
}

TEST(GlobalCloud, LidarsLearnSideBySideWhileRequestsAsk) {
  GlobalCloud in_turn(two_lidars(), {}), at_once(two_lidars(), {});
  const auto feed = [](GlobalCloud& cloud, std::size_t lidar) {
    for (int i = 0; i < 40; ++i) EXPECT_TRUE(cloud.add_depth(lidar, wall(kT0 + from_ms(50 * i))));
  };
  for (const std::size_t lidar : {0U, 1U}) feed(in_turn, lidar);
  {
    const std::jthread a([&] { feed(at_once, 0); }), b([&] { feed(at_once, 1); });
    const std::jthread asks([&] {
      for (int i = 0; i < 40; ++i)
        if (const auto snapshot = at_once.nearest(kT0 + from_ms(50 * i))) (void)(*snapshot)->target();
    });
    for (int i = 0; i < 10; ++i) at_once.prepare();
  }
  const StampNs last = kT0 + from_ms(50 * 39);
  const auto expected = in_turn.nearest(last), snapshot = at_once.nearest(last);
  ASSERT_TRUE(expected && snapshot);
  EXPECT_EQ((*snapshot)->frames().size(), 2U);
  EXPECT_EQ((*snapshot)->target()->cloud.points, (*expected)->target()->cloud.points);
}

TEST(GlobalCloud, KeepsThreeSeconds) {
  GlobalCloud cloud(two_lidars(), {});
  for (int i = 0; i <= 50; ++i) ASSERT_TRUE(cloud.add_depth(0, wall(kT0 + from_ms(100 * i))));
  EXPECT_TRUE(cloud.nearest(kT0 + from_ms(2000)));
  EXPECT_FALSE(cloud.nearest(kT0 + from_ms(1800)));
}

TEST(GlobalCloud, StitchesInTheMapFrame) {
  Site site = two_lidars();
  site.global_lidars[1].T_map_sensor.linear() =
      Eigen::AngleAxisd(M_PI, Eigen::Vector3d::UnitY()).toRotationMatrix();
  GlobalCloud cloud(site, {});
  ASSERT_TRUE(cloud.add_depth(0, wall(kT0)));
  ASSERT_TRUE(cloud.add_depth(1, wall(kT0)));
  const Target& target = (*cloud.nearest(kT0))->target();
  ASSERT_FALSE(target->cloud.empty());
  std::size_t front = 0;
  for (std::size_t i = 0; i < target->cloud.size(); ++i) {
    EXPECT_NEAR(std::abs(target->cloud.points[i].z()), 2.0F, 0.01F);
    EXPECT_LT(target->cloud.normals[i].z() * target->cloud.points[i].z(), 0) << "normals face their sensor";
    front += target->cloud.points[i].z() > 0;
  }
  EXPECT_GT(front, target->cloud.size() / 3);
  EXPECT_LT(front, target->cloud.size() * 2 / 3);
}

TEST(GlobalCloud, PointsAndDepthGiveTheSameCloud) {
  GlobalCloud depth(two_lidars(), {}), points(two_lidars(), {});
  ASSERT_TRUE(depth.add_depth(0, wall(kT0)));
  const auto cloud_sensor = depth_to_cloud(wall(kT0), kCamera);
  ASSERT_TRUE(points.add_points(0, kT0, *cloud_sensor));
  EXPECT_EQ((*depth.nearest(kT0))->target()->cloud.size(), (*points.nearest(kT0))->target()->cloud.size());
}

}  // namespace
}  // namespace liloc
