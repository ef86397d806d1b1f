// Real processes on a network of their own: a lossy link and a killed server at once, a device that roams. The
// whole list: liloc_faults.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <memory>
#include <sstream>
#include <thread>

#include "common/testing/within.hpp"
#include "proto-tests/faults/verdict.hpp"
#include "proto-tests/replay/tests/temp_folder.hpp"
#include "proto-tests/sim/write_recording.hpp"

namespace liloc::faults {
namespace {

using namespace std::chrono_literals;
using test::within;
using testing::HasSubstr;

#ifdef LILOC_SANITIZED
constexpr bool kMeasured = false;  // ten times slower: the processes are exercised, their answers come too late
#else
constexpr bool kMeasured = true;
#endif

std::string text_of(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

class Faults : public testing::Test {
 protected:
  void SetUp() override {
    if (const Status may = permitted(); !may) GTEST_SKIP() << may.error().message;
    const Status entered = enter_own_namespaces();
    ASSERT_TRUE(entered) << entered.error().message;
  }
  static void TearDownTestSuite() { site_.reset(); }
  /// Ten seconds of a site and a device, the same for all.
  static Result<Recording> recording() {
    if (!site_) {
      site_ = std::make_unique<replay::TempFolder>();
      sim::SimOptions site;
      site.seed = 7;
      site.seconds = 10;
      site.still_seconds = 1;
      site.device_rate_hz = 10;
      if (Status written = sim::write_recording(site, site_->path() / "rec"); !written)
        return tl::unexpected(written.error());
    }
    return open_recording(site_->path() / "rec");
  }
  void play(const Scenario& scenario) {
    const auto recording = Faults::recording();
    ASSERT_TRUE(recording) << recording.error().message;
    const auto performed = perform(scenario, *recording, {LILOC_PROGRAMS, folder_.path() / "out", 7});
    ASSERT_TRUE(performed) << performed.error().message;
    verdict_ = judge(scenario, *performed);
    EXPECT_EQ(verdict_.wrong, 0U);
    EXPECT_GT(verdict_.requests, 0U);
    if (!kMeasured) return;
    EXPECT_TRUE(verdict_.good()) << to_json({verdict_});
    EXPECT_EQ(verdict_.located, verdict_.frames) << "a pose at every frame, whatever is away";
  }

  static inline std::unique_ptr<replay::TempFolder> site_;
  replay::TempFolder folder_;
  Verdict verdict_;
};

TEST_F(Faults, ALossyLinkAndAKilledServerCostTimeAndNothingElse) {
  Scenario scenario;
  scenario.name = "loss and kill";
  scenario.seconds = 10;
  scenario.acts = {{0, Mark::none,
                    [](Stage& stage) {
                      stage.network().set(kDevice, {.loss = 0.05, .delay_ms = 10, .jitter_ms = 5});
                      return Status{};
                    }},
                   {4, Mark::begins,
                    [](Stage& stage) {
                      stage.kill_server(0);
                      return Status{};
                    }},
                   {4.5, Mark::over, [](Stage& stage) { return stage.start_server(0); }}};
  play(scenario);
  EXPECT_GT(verdict_.frames_lost, 0);
}

TEST_F(Faults, ADeviceThatRoamsJoinsAnewAndIsLocatedAgain) {
  Scenario scenario;
  scenario.name = "roaming";
  scenario.seconds = 10;
  scenario.acts = {
      {3, Mark::begins_and_over, [](Stage& stage) { return stage.change_device_address("10.77.0.104"); }}};
  play(scenario);
  EXPECT_THAT(text_of(folder_.path() / "out" / kDevice / "client.log"), HasSubstr("joining the network anew"));
}

/// Its sensors hold the domain, and with it the address of its start.
TEST_F(Faults, ADaemonThatRoamsEndsSoThatItIsStartedAnew) {
  auto network = BadNetwork::create({kDevice}, 7);
  ASSERT_TRUE(network) << network.error().message;
  const auto log = folder_.path() / "client.log", device = folder_.path() / "device.json";
  std::ofstream(device)
      << R"({"id": "robot1", "width": 64, "height": 48, "fx": 50, "fy": 50, "cx": 32, "cy": 24,
                               "depth_scale": 0.001, "rate_hz": 10})";
  Result<replay::Child> daemon = fail("not started");
  NetworkHost& host = (*network)->host(kDevice);
  host.within([&] {
    daemon = replay::Child::start({std::string(LILOC_PROGRAMS) + "/liloc-client", "--id", "robot1", "--device",
                                   device, "--interface", kInterface, "--peer", "10.77.0.2"},
                                  log);
  });
  ASSERT_TRUE(daemon) << daemon.error().message;
  ASSERT_TRUE(within(20s, [&] { return text_of(log).find("listens on domain") != std::string::npos; }));
  std::this_thread::sleep_for(1s);
  ASSERT_TRUE(daemon->running()) << daemon->failure().message;
  const Status changed = host.change_address("10.77.0.104");
  ASSERT_TRUE(changed) << changed.error().message;
  ASSERT_TRUE(within(20s, [&] { return !daemon->running(); }));
  EXPECT_THAT(daemon->failure().message, HasSubstr("ended with exit code 1"));
  EXPECT_THAT(text_of(log), HasSubstr("the address on lan0 has changed"));
}

}  // namespace
}  // namespace liloc::faults
