// Real processes on a network of their own: a lossy link and a killed server at once. The whole list:
// liloc_faults.
#include <gtest/gtest.h>

#include "proto-tests/faults/verdict.hpp"
#include "proto-tests/replay/tests/temp_folder.hpp"
#include "proto-tests/sim/write_recording.hpp"

namespace liloc::faults {
namespace {

#ifdef LILOC_SANITIZED
constexpr bool kMeasured = false;  // ten times slower: the processes are exercised, their answers come too late
#else
constexpr bool kMeasured = true;
#endif

TEST(Faults, ALossyLinkAndAKilledServerCostTimeAndNothingElse) {
  if (const Status entered = enter_own_namespaces(); !entered) GTEST_SKIP() << entered.error().message;
  if (const auto probe = BadNetwork::create({"probe"}, 1); !probe) GTEST_SKIP() << probe.error().message;
  const replay::TempFolder folder;
  sim::SimOptions site;
  site.seed = 7;
  site.seconds = 10;
  site.still_seconds = 1;
  site.device_rate_hz = 10;
  const Status written = sim::write_recording(site, folder.path() / "rec");
  ASSERT_TRUE(written) << written.error().message;
  const auto recording = open_recording(folder.path() / "rec");
  ASSERT_TRUE(recording) << recording.error().message;

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
  const auto performed = perform(scenario, *recording, {LILOC_PROGRAMS, folder.path() / "out", 7});
  ASSERT_TRUE(performed) << performed.error().message;
  const Verdict verdict = judge(scenario, *performed);
  EXPECT_EQ(verdict.wrong, 0U);
  EXPECT_GT(verdict.frames_lost, 0);
  EXPECT_GT(verdict.requests, 0U);
  if (kMeasured) {
    EXPECT_TRUE(verdict.good()) << to_json({verdict});
    EXPECT_EQ(verdict.located, verdict.frames) << "a pose at every frame, also while the server is away";
  }
}

}  // namespace
}  // namespace liloc::faults
