#include "proto-tests/faults/scenario.hpp"

#include <random>
#include <thread>

namespace liloc::faults {
namespace {

constexpr double kLead_s = 2.5;  // for processes to start and find each other
constexpr double kTail_s = 1;    // until the device has stopped
constexpr double kOneInterval_s = 0.8;

/// Errors: a server ended, a stop signal.
Status wait_until(Stage& stage, const Performance& performance, double at_s) {
  while (performance.now_s() < at_s) {
    if (replay::stop_requested()) return fail("faults: stopped by a signal");
    if (const Status ok = stage.check(); !ok) return ok;
    const double rest_s = std::min(at_s - performance.now_s(), 0.02);
    if (rest_s > 0) std::this_thread::sleep_for(std::chrono::duration<double>(rest_s));
  }
  return {};
}

/// Faults of processes and links come anywhere within an interval of requests, those of streams where they are.
double moved(const Scenario& scenario, const Act& act, std::uint64_t seed) {
  const bool of_streams = !scenario.streams.silent_lidars.empty() || scenario.streams.device_step_s != 0 ||
                          scenario.streams.ceiling_step_s != 0;
  if (of_streams || act.at_s <= 0) return act.at_s;
  std::mt19937_64 random(seed);
  return act.at_s + std::uniform_real_distribution<double>(0, kOneInterval_s)(random);
}

}  // namespace

Result<Performed> perform(const Scenario& scenario, const Recording& recording, const PerformOptions& options) {
  auto stage = Stage::open({options.programs, options.out, scenario.servers, scenario.small_disk, options.seed},
                           recording);
  if (!stage) return tl::unexpected(stage.error());
  const auto lead =
      std::chrono::duration_cast<std::chrono::steady_clock::duration>(std::chrono::duration<double>(kLead_s));
  const Performance performance{recording, std::chrono::steady_clock::now() + lead, scenario.seconds,
                                scenario.streams};
  if (const Status begun = (*stage)->begin(performance); !begun) return tl::unexpected(begun.error());
  Performed performed;
  for (const Act& act : scenario.acts) {
    if (const Status due = wait_until(**stage, performance, moved(scenario, act, options.seed)); !due)
      return tl::unexpected(due.error());
    const double before_s = performance.now_s();
    if (const Status done = act.run(**stage); !done) return tl::unexpected(done.error());
    if (act.mark == Mark::begins || act.mark == Mark::begins_and_over) performed.times.begins_s = before_s;
    if (act.mark == Mark::over || act.mark == Mark::begins_and_over) performed.times.over_s = before_s;
  }
  if (const Status over = wait_until(**stage, performance, scenario.seconds + kTail_s); !over)
    return tl::unexpected(over.error());
  auto story = (*stage)->end();
  if (!story) return tl::unexpected(story.error());
  performed.story = std::move(*story);
  performed.frames = (*stage)->network().counters(kDevice);
  return performed;
}

}  // namespace liloc::faults
