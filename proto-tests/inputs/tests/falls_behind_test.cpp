// liloc sim --live that was stopped for a while, as on a laptop whose lid is closed.
#include <csignal>

#include "common/wire/sensors/sensors.hpp"
#include "proto-tests/inputs/tests/live_site.hpp"

namespace liloc::inputs {
namespace {

using testing::HasSubstr;

TEST(FallsBehind, AStoppedSimulationLeavesOutWhatIsLateSaysSoAndGoesOn) {
  const auto domain = replay::free_domain();
  ASSERT_TRUE(domain) << domain.error().message;
  std::mutex mutex;
  std::vector<StampNs> stamps_ns;
  const auto seat = wire::Participant::create({.domain = *domain, .role = wire::Role::server});
  ASSERT_TRUE(seat) << seat.error().message;
  const auto dispatcher = wire::Dispatcher::create(*seat).value();
  ASSERT_TRUE(wire::subscribe_depth(*dispatcher, "ceiling0", 0.001, [&](const Result<DepthImage>& image) {
    const std::scoped_lock lock(mutex);
    if (image) stamps_ns.push_back(image->stamp_ns);
  }));
  dispatcher->start();
  const auto heard = [&] {
    const std::scoped_lock lock(mutex);
    return stamps_ns.size();
  };
  const replay::TempFolder folder;
  const auto log = folder.path() / "sim.log";
  auto sim =
      replay::Child::start({LILOC_PROGRAM, "sim", "--live", "--domain", std::to_string(*domain), "--seconds",
                            "60", "--lidars", "2", "--image-width", "160", "--image-height", "120"},
                           log);
  ASSERT_TRUE(sim) << sim.error().message;
  ASSERT_TRUE(within(30s, [&] { return heard() >= 4; })) << replay::last_lines(log, 5);
  ASSERT_EQ(kill(sim->pid(), SIGSTOP), 0);
  std::this_thread::sleep_for(2s);
  const std::size_t before = heard();
  ASSERT_EQ(kill(sim->pid(), SIGCONT), 0);
  EXPECT_TRUE(within(10s, [&] { return heard() >= before + 9; })) << replay::last_lines(log, 5);
  EXPECT_TRUE(sim->running());
  const Status stopped = sim->stop();
  EXPECT_TRUE(stopped) << stopped.error().message;
  dispatcher->stop();
  const std::string told = replay::last_lines(log, 5);
  EXPECT_THAT(told, HasSubstr("liloc: sim: behind real time: "));
  // Two LiDARs at 6 Hz and a device at 15: 54 images in two seconds, but for those that were nearly due.
  const auto at = told.find(" images were left out in all");
  ASSERT_NE(at, std::string::npos) << told;
  const int left_out = std::stoi(told.substr(told.rfind(' ', at - 1) + 1));
  EXPECT_GE(left_out, 40) << told;
  if (kMeasured) {
    EXPECT_LE(left_out, 80) << told;
  }
  EXPECT_TRUE(std::ranges::is_sorted(stamps_ns));
}

}  // namespace
}  // namespace liloc::inputs
