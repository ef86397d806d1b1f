// liloc_faults: a site of real processes on a network of its own is maltreated, one fault at a time.
// Exit code 0: nothing wrong was verified and all recovered; 1: not so; 2: bad usage; 77: not permitted here.
#include <CLI/CLI.hpp>

#include "common/command/checks.hpp"
#include "common/recording/files.hpp"
#include "proto-tests/faults/verdict.hpp"
#include "proto-tests/sim/write_recording.hpp"

namespace liloc::faults {
namespace {

namespace fs = std::filesystem;

constexpr int kDone = 0, kFailed = 1, kBadUsage = 2, kNotPermitted = 77;

struct Arguments {
  fs::path out;
  std::vector<std::string> only;
  int repeat = 1;
  std::uint64_t seed = 7;
  bool list = false;
};

int complain(const Error& error, int exit_code) {
  fmt::print(stderr, "liloc_faults: {}\n", error.message);
  return exit_code;
}

sim::SimOptions site_options(std::uint64_t seed) {
  sim::SimOptions options;
  options.seed = seed;
  options.lidars = 3;
  options.people = 2;
  options.devices = 1;
  options.device_rate_hz = 10;
  options.seconds = kLongest_s;
  options.still_seconds = 1;
  return options;
}

Result<Recording> recording_of(const Arguments& arguments) {
  const fs::path folder = arguments.out / fmt::format("recording-{}", arguments.seed);
  if (!fs::exists(folder / "site.json")) {
    fmt::print(stderr, "simulating {} s into {}\n", kLongest_s, folder.string());
    if (const Status written = sim::write_recording(site_options(arguments.seed), folder); !written)
      return tl::unexpected(written.error());
  }
  return open_recording(folder);
}

int run_all(const Arguments& arguments, const std::vector<Scenario>& chosen) {
  const auto recording = recording_of(arguments);
  if (!recording) return complain(recording.error(), kFailed);
  std::vector<Verdict> verdicts;
  bool all_performed = true;
  for (const Scenario& scenario : chosen)
    for (int i = 0; i < arguments.repeat; ++i) {
      const auto seed = arguments.seed + static_cast<std::uint64_t>(i);
      const auto performed =
          perform(scenario, *recording,
                  {replay::program_folder(), arguments.out / fmt::format("{}-{}", scenario.name, i + 1), seed});
      if (replay::stop_requested()) return complain({"stopped by a signal"}, kFailed);
      if (!performed) {
        complain({fmt::format("{}: {}", scenario.name, performed.error().message)}, kFailed);
        all_performed = false;
        continue;
      }
      verdicts.push_back(judge(scenario, *performed));
      fmt::print(stderr, "{}", to_table({verdicts.back()}).substr(to_table({}).size()));
      if (const Status written = write_file(arguments.out / "faults.json", to_json(verdicts)); !written)
        return complain(written.error(), kFailed);
    }
  fmt::print("{}", to_table(verdicts));
  return all_performed && std::ranges::all_of(verdicts, &Verdict::good) ? kDone : kFailed;
}

int run(const Arguments& arguments) {
  if (arguments.list) {
    for (const Scenario& scenario : scenarios()) fmt::print("{:18} {}\n", scenario.name, scenario.what);
    return kDone;
  }
  if (arguments.out.empty()) return complain({"OUT is missing; name a folder for what is written"}, kBadUsage);
  std::vector<Scenario> chosen = scenarios();
  if (!arguments.only.empty()) chosen.clear();
  for (const std::string& name : arguments.only) {
    auto scenario = scenario_named(name);
    if (!scenario) return complain({"--only: " + scenario.error().message}, kBadUsage);
    chosen.push_back(std::move(*scenario));
  }
  if (const Status may = permitted(); !may) return complain(may.error(), kNotPermitted);
  if (const Status entered = enter_own_namespaces(); !entered) return complain(entered.error(), kFailed);
  replay::catch_stop_signals();
  return run_all(arguments, chosen);
}

}  // namespace
}  // namespace liloc::faults

int main(int argc, char** argv) {
  using namespace liloc;
  faults::Arguments arguments;
  CLI::App app(
      "A site of real processes on a network of its own, maltreated: what is lost, how soon it recovers.",
      "liloc_faults");
  app.add_option("OUT", arguments.out, "Folder for faults.json, the recording that is played, and logs");
  app.add_option("--only", arguments.only, "These scenarios alone; see --list");
  app.add_option("--repeat", arguments.repeat, "Runs of each, with the fault at other moments")
      ->check(command::in_range(1, 1000))
      ->capture_default_str();
  app.add_option("--seed", arguments.seed, "Of the site, the network and the moments")
      ->check(command::any_seed())
      ->capture_default_str();
  app.add_flag("--list", arguments.list, "Name the scenarios");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : faults::kBadUsage;
  }
  try {
    return faults::run(arguments);
  } catch (const std::exception& error) {
    fmt::print(stderr, "liloc_faults: {}\n", error.what());
    return 1;
  }
}
