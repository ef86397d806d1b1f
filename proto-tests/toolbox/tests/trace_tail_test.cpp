#include "proto-tests/toolbox/trace_tail.hpp"

#include <gmock/gmock.h>

#include "proto-tests/replay/tests/temp_folder.hpp"
#include "proto-tests/toolbox/device_table.hpp"

namespace liloc::toolbox {
namespace {

TEST(TraceTail, HandsOutWholeLinesOnce) {
  const replay::TempFolder folder;
  TraceTail tail(folder.path());
  EXPECT_TRUE(tail.poll().poses.empty());  // nothing there yet

  std::ofstream online(folder.path() / "online.tum");
  online << "# timestamp_s tx ty tz qx qy qz qw\n1700000000.000000001 1 2 3 0 0 0 1\n1700000000.1"
         << std::flush;
  const auto first = tail.poll().poses;
  ASSERT_EQ(first.size(), 1u);
  EXPECT_EQ(first[0].stamp_ns, 1'700'000'000'000'000'001);
  EXPECT_EQ(first[0].T_map_sensor.translation(), Eigen::Vector3d(1, 2, 3));

  online << "00000000 4 5 6 0 0 0 1\n" << std::flush;
  const auto second = tail.poll().poses;
  ASSERT_EQ(second.size(), 1u);
  EXPECT_EQ(second[0].stamp_ns, 1'700'000'000'100'000'000);
  EXPECT_TRUE(tail.poll().poses.empty());
}

TEST(TraceTail, CountsSpotsByTheirStatus) {
  const replay::TempFolder folder;
  std::ofstream(folder.path() / "spots.csv") << "stamp_ns,status,reason,latency_ms\n1,verified,confirmed,10\n"
                                                "2,refused,no_gpc,2\n3,provisional,weak,30\n";
  TraceTail tail(folder.path());
  const DeviceNews& news = tail.poll();
  EXPECT_EQ(news.asked, 3u);
  EXPECT_EQ(news.verified, 1u);
  EXPECT_EQ(news.refused, 1u);
  EXPECT_EQ(news.last_reason, "weak");
  EXPECT_THAT(news.latencies_ms, testing::ElementsAre(10, 2, 30));
}

TEST(DeviceTable, SaysWhichDeviceWasNeverLocated) {
  DeviceRow lost, found;
  lost.id = "device0";
  lost.news.last_reason = "no_gpc";
  found.id = "device1";
  found.first_pose_s = 1.5;
  found.errors_cm = {1, 3};
  found.errors_deg = {0.1, 0.3};
  const auto lines = summary_lines({lost, found});
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_THAT(lines[0], testing::HasSubstr("device0: never located"));
  EXPECT_THAT(lines[1], testing::HasSubstr("located after 1.5 s; mean error 2.0 cm 0.20 deg, at most 3.0 cm"));
  EXPECT_EQ(table_lines({lost, found}).size(), 3u);
}

}  // namespace
}  // namespace liloc::toolbox
