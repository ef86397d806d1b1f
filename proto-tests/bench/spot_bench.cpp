// How well and how fast single spots are found, cold and with history, on simulated sites whose seeds are named
// and on recordings; and how many published pairs of clouds are aligned.
//
//   liloc_spot_bench --sites 100 [--first-seed 1] [--jobs 2] [--threads 1] [--csv rows.csv] [--no-gravity]
//   liloc_spot_bench --sites 100 --recordings DIR... --pairs DIR --threads 1 2 --peer-every 10   # all in one
//   run,
//                                                                       # PCL and Open3D on the same clouds
//   liloc_spot_bench --sites 100 --evidence rows.csv   # what fit_confidence.py makes the confidence of
//
// The devices run the client's engine, so that requests are what a server gets.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "proto-tests/bench/spot_bench_pair_rows.hpp"
#include "proto-tests/bench/spot_bench_pairs.hpp"
#include "proto-tests/bench/spot_bench_spots.hpp"

namespace liloc::bench {
namespace {

constexpr int kSites = 20;  // when nothing else is asked for

struct Options {
  std::optional<int> sites;
  std::vector<int> threads{1};
  std::string pairs, pair_rows, csv, evidence;
  SpotsOptions spots;

  [[nodiscard]] Status validated() const {
    if (threads.size() > 1 && (!csv.empty() || !evidence.empty()))
      return fail("--csv and --evidence hold rows of one number of --threads, not of {}", threads.size());
    return {};
  }
};

/// Sites, recordings and pairs, each if it is asked for.
Result<TrialResult> run_with(const Options& options, int threads) {
  SpotsOptions spots = options.spots;
  spots.trial.threads = threads;
  spots.trial.evidence = !options.evidence.empty();
  TrialResult all;
  const auto run = [&](const SpotsOptions& part) -> Status {
    auto result = run_spots(part);
    if (!result) return tl::unexpected(result.error());
    all.rows.insert(all.rows.end(), result->rows.begin(), result->rows.end());
    all.evidence.insert(all.evidence.end(), result->evidence.begin(), result->evidence.end());
    return {};
  };
  Status done;
  if (!spots.recordings.empty()) done = run(spots);
  spots.recordings.clear();
  if (done && spots.sites > 0) done = run(spots);
  if (done && !options.pairs.empty() && !options.pair_rows.empty())
    done = write_pair_rows(options.pairs, options.pair_rows);
  else if (done && !options.pairs.empty())
    done = run_pairs({options.pairs, threads, spots.trial.peer_every});
  if (!done) return tl::unexpected(done.error());
  return all;
}

Status run(Options options) {
  if (Status sound = options.validated(); !sound) return sound;
  options.spots.sites =
      options.sites.value_or(options.spots.recordings.empty() && options.pairs.empty() ? kSites : 0);
  for (const int threads : options.threads) {
    const auto result = run_with(options, threads);
    if (!result) return tl::unexpected(result.error());
    if (!options.csv.empty())
      if (Status written = write_csv(options.csv, result->rows); !written) return written;
    if (!options.evidence.empty())
      if (Status written = write_evidence(options.evidence, result->evidence); !written) return written;
  }
  return {};
}

void add_sensor(CLI::App& app, const std::string& name, sim::SensorModel& model) {
  app.add_option_function<std::string>(
      name,
      [&model](const std::string& text) {
        const auto named = sim::sensor_model_of(text);
        if (!named) throw CLI::ValidationError(named.error().message);
        model = *named;
      },
      "Of the simulated sites: l515 (default), l515-real, kinect or tof");
}

void declare(CLI::App& app, Options& options) {
  SpotsOptions& spots = options.spots;
  app.add_option("--sites", options.sites,
                 fmt::format("Number of simulated sites; {} unless recordings or pairs are asked for", kSites))
      ->check(CLI::Range(1, 10000));
  app.add_option("--first-seed", spots.first_seed, "Seed of the first site")->capture_default_str();
  app.add_option("--seconds", spots.seconds, "Simulated per site")
      ->check(CLI::Range(2, 600))
      ->capture_default_str();
  app.add_option("--world", spots.style.world, "Whose furniture, people and mounts: 1 or 2")
      ->check(CLI::Range(1, 2))
      ->capture_default_str();
  add_sensor(app, "--lidar-sensor", spots.style.lidar_sensor);
  add_sensor(app, "--device-sensor", spots.style.device_sensor);
  app.add_option("--recordings", spots.recordings, "Folders of recordings");
  app.add_option("--jobs", spots.jobs, "Sites at a time; each runs in one thread")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--threads", options.threads, "Per request; several: all is run with each in turn")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--pairs", options.pairs, "Folder of pairs with their gt.log");
  app.add_option("--pair-rows", options.pair_rows,
                 "Of the pairs, append a row for each pose in question to this file, for fit_align.py");
  app.add_option("--peer-every", spots.trial.peer_every,
                 "Ask PCL and Open3D for one in so many spots or pairs; 0: never")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  app.add_option("--csv", options.csv, "Write a row per spot");
  app.add_option("--evidence", options.evidence, "Write what each search rested on, for fit_confidence.py");
  app.add_flag_callback(
      "--no-gravity", [&spots] { spots.trial.gravity = false; }, "Requests do not say where up is");
  app.add_flag("--verbose", spots.verbose, "Print every spot");
}

}  // namespace
}  // namespace liloc::bench

int main(int argc, char** argv) {
  liloc::bench::Options options;
  CLI::App app{
      "Spots on simulated sites and recordings: success by overlap, wrong verified answers, latency. The room "
      "is "
      "prepared before each request, as the server does beside its requests; what that takes is a figure of "
      "its "
      "own. On a busy machine compare CPU times, not latencies."};
  declare(app, options);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  const auto done = liloc::bench::run(std::move(options));
  if (!done) fmt::print(stderr, "liloc_spot_bench: {}\n", done.error().message);
  return done ? 0 : 1;
}
