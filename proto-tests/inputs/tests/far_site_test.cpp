// Memory follows what is seen, not how far apart rooms lie: two servers on the same streams.
#include "common/recording/writer.hpp"
#include "proto-tests/inputs/tests/live_site.hpp"

namespace liloc::inputs {
namespace {

TEST(FarSite, ARoomNineHundredMetresOffTakesNoMoreMemoryThanOneNextDoor) {
  const int near_domain = replay::free_domain().value_or(0);
  const int far_domain = near_domain + 1;
  auto site = PlayedSite::start(small_site(3, 1), {near_domain, far_domain});
  ASSERT_TRUE(site) << site.error().message;
  const replay::TempFolder folder;
  ASSERT_TRUE((*site)->describe(folder.path()));
  // The third LiDAR hangs in a room of its own, next door or at the other end of the premises.
  for (const auto& [name, away_m] : {std::pair{"near.json", 40.0}, {"far.json", 900.0}}) {
    Site moved = (*site)->site();
    moved.global_lidars[2].T_map_sensor.translation().x() += away_m;
    ASSERT_TRUE(write_site(folder.path() / name, moved));
  }
  const auto near_server =
      ServerProcess::start(near_domain, folder.path() / "near.json", folder.path() / "near.log");
  const auto far_server =
      ServerProcess::start(far_domain, folder.path() / "far.json", folder.path() / "far.log");
  ASSERT_TRUE(near_server) << near_server.error().message;
  ASSERT_TRUE(far_server) << far_server.error().message;
  std::vector<std::unique_ptr<Robot>> robots;
  for (const int domain : {near_domain, far_domain}) {
    auto robot = Robot::start({"--id", "device0", "--domain", std::to_string(domain), "--device",
                               (folder.path() / "device0.json").string(), "--interval-ms", "400"});
    ASSERT_TRUE(robot) << robot.error().message;
    robots.push_back(std::move(*robot));
  }
  const auto answered = [](const auto& server) {
    const auto status = (*server)->status();
    return status && status->answered >= 10;
  };
  EXPECT_TRUE(within(kMeasured ? 30s : 120s, [&] { return answered(near_server) && answered(far_server); }))
      << replay::last_lines(folder.path() / "far.log", 5);
  for (const auto* server : {&near_server, &far_server})
    for (std::size_t i = 0; i < 3; ++i) EXPECT_TRUE(wire::is_heard((**server)->lidar(i).state)) << i;
  const double near_mb = (*near_server)->peak_mb(), far_mb = (*far_server)->peak_mb();
  RecordProperty("near_mb", static_cast<int>(near_mb));
  RecordProperty("far_mb", static_cast<int>(far_mb));
  EXPECT_GT(near_mb, 10);
  EXPECT_LT(far_mb, 2 * near_mb)
      << "40 times as much where a grid covers what lies between; peaks differ by half";
}

}  // namespace
}  // namespace liloc::inputs
