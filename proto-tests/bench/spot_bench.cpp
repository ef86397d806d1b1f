// How well and how fast single spots are found, cold and with history, on simulated sites whose seeds are named
// and on recordings.
//
//   liloc_spot_bench --sites 100 [--first-seed 1] [--jobs 2] [--threads 1] [--csv rows.csv] [--no-gravity]
//   liloc_spot_bench --recordings DIR...
//   liloc_spot_bench --pairs DIR [--peer-every 1]
//   liloc_spot_bench --sites 100 --peer-every 10   # PCL and Open3D on the same clouds
//   liloc_spot_bench --sites 100 --evidence rows.txt; liloc_spot_bench --sweep rows.txt   # thresholds, as
//   Markdown
//
// The devices run the client's engine, so that requests are what a server gets.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <atomic>
#include <mutex>
#include <thread>

#include "proto-tests/bench/spot_bench_pairs.hpp"
#include "proto-tests/bench/spot_bench_sweep.hpp"
#include "proto-tests/bench/spot_bench_tables.hpp"
#include "proto-tests/bench/spot_bench_trial.hpp"

namespace liloc::bench {
namespace {

struct Options {
  int sites = 20, jobs = 1;
  std::uint64_t first_seed = 1;
  double seconds = 12;
  std::vector<std::string> recordings;
  bool verbose = false;
  std::string pairs, csv, evidence, sweep;
  TrialOptions trial;
};

Result<Stage> open_stage(const Options& options, std::size_t index) {
  if (!options.recordings.empty()) return recorded_stage(options.recordings[index]);
  return simulated_stage(options.first_seed + index, options.seconds);
}

void print_rows(const std::vector<Row>& rows) {
  for (const Row& r : rows)
    fmt::print("site {} {} {} overlap {:.2f} error {:6.2f} deg {:6.3f} m {} {} margin {:.2f} nees {:.1f} {}\n",
               r.seed, r.reply.client_id, r.cold ? "cold" : "hist", r.overlap, r.error_deg, r.error_m,
               name_of(r.reply.status), name_of(r.reply.reason), r.reply.margin, r.nees, r.reply.text);
}

/// All stages, `jobs` at a time; rows in the order of the stages. Error: the first that a stage met.
Result<TrialResult> run_stages(const Options& options) {
  const std::size_t count =
      options.recordings.empty() ? static_cast<std::size_t>(options.sites) : options.recordings.size();
  std::vector<Result<TrialResult>> results(count);
  std::atomic<std::size_t> next{0};
  std::mutex printing;
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      auto stage = open_stage(options, i);
      const std::string name = stage ? stage->name : "";
      results[i] = stage ? run_trial(std::move(*stage), options.trial) : tl::unexpected(stage.error());
      const std::scoped_lock lock(printing);
      if (!results[i]) {
        fmt::print(stderr, "site {}: {}\n", options.first_seed + i, results[i].error().message);
      } else if (options.verbose) {
        fmt::print("{}\n", name);
        print_rows(results[i]->rows);
      }
    }
  };
  {
    std::vector<std::jthread> workers;
    for (int j = 0; j < options.jobs; ++j) workers.emplace_back(work);
  }
  TrialResult all;
  for (auto& result : results) {
    if (!result) return tl::unexpected(result.error());
    all.rows.insert(all.rows.end(), result->rows.begin(), result->rows.end());
    const std::size_t before = all.rows.size() - result->rows.size();
    for (PeerProblem& problem : result->problems) {
      problem.row += before;
      all.problems.push_back(std::move(problem));
    }
    all.evidence.insert(all.evidence.end(), result->evidence.begin(), result->evidence.end());
  }
  return all;
}

/// PCL and Open3D on the spots that were kept for them, beside our own answers.
void run_peers(const TrialResult& ours, int threads) {
  Method cold{"LiLoc cold", {}}, history{"LiLoc with history", {}}, pcl{"PCL", {}}, open3d{"Open3D", {}};
  const auto row_of = [](const PeerProblem& problem, const PeerAnswer& answer) {
    SpotReply reply;
    reply.T_map_sensor = answer.T_target_source;
    reply.latency_ms = answer.latency_ms;
    Row row = judged(std::move(reply), problem.T_target_source_true);
    row.overlap = problem.overlap;
    return row;
  };
  for (const PeerProblem& problem : ours.problems) {
    cold.rows.push_back(ours.rows[problem.row]);
    history.rows.push_back(ours.rows[problem.row + 1]);
    pcl.rows.push_back(row_of(problem, ask_pcl(problem, threads)));
  }
  std::vector<Method> methods{std::move(cold), std::move(history), std::move(pcl)};
  if (const auto answers = ask_open3d(ours.problems, threads)) {
    for (std::size_t i = 0; i < answers->size(); ++i)
      open3d.rows.push_back(row_of(ours.problems[i], (*answers)[i]));
    methods.push_back(std::move(open3d));
  } else {
    fmt::print("{}\n", answers.error().message);
  }
  print_methods(methods);
}

int complain(const Error& error) {
  fmt::print(stderr, "{}\n", error.message);
  return 1;
}

int run(const Options& options) {
  if (!options.sweep.empty()) {
    const auto evidence = read_evidence(options.sweep);
    if (!evidence) return complain(evidence.error());
    print_sweep(*evidence);
    return 0;
  }
  if (!options.pairs.empty()) {
    const Status done = run_pairs({options.pairs, options.trial.threads, options.trial.peer_every});
    return done ? 0 : complain(done.error());
  }
  const auto result = run_stages(options);
  if (!result) return 1;
  const std::string what = options.recordings.empty()
                               ? fmt::format("{} sites from seed {}", options.sites, options.first_seed)
                               : fmt::format("{} recordings", options.recordings.size());
  fmt::print("{}, {} thread(s), {} job(s), gravity {}\n", what, options.trial.threads, options.jobs,
             options.trial.gravity ? "known" : "unknown");
  print_success(result->rows, true);
  print_success(result->rows, false);
  print_by_site(result->rows);
  print_consistency(result->rows);
  if (options.trial.peer_every > 0) run_peers(*result, options.trial.threads);
  if (!options.csv.empty())
    if (const Status written = write_csv(options.csv, result->rows); !written) return complain(written.error());
  if (!options.evidence.empty())
    if (const Status written = write_evidence(options.evidence, result->evidence); !written)
      return complain(written.error());
  return 0;
}

}  // namespace
}  // namespace liloc::bench

int main(int argc, char** argv) {
  liloc::bench::Options options;
  CLI::App app{
      "Spots on simulated sites: success by overlap, wrong verified answers, latency. The room is prepared "
      "before each request, as the server does beside its requests; what that takes is a figure of its own. "
      "On a busy machine compare CPU times, not latencies."};
  app.add_option("--sites", options.sites, "Number of sites")
      ->check(CLI::Range(1, 10000))
      ->capture_default_str();
  app.add_option("--first-seed", options.first_seed, "Seed of the first site")->capture_default_str();
  app.add_option("--seconds", options.seconds, "Simulated per site")
      ->check(CLI::Range(2, 600))
      ->capture_default_str();
  app.add_option("--recordings", options.recordings, "Folders of recordings, in place of simulated sites");
  app.add_option("--jobs", options.jobs, "Sites at a time; each runs in one thread")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--threads", options.trial.threads, "Per request")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  app.add_option("--pairs", options.pairs, "Folder of pairs with their gt.log, in place of sites");
  app.add_option("--peer-every", options.trial.peer_every,
                 "Ask PCL and Open3D for one in so many spots or pairs; 0: never")
      ->check(CLI::Range(0, 1000))
      ->capture_default_str();
  app.add_option("--csv", options.csv, "Write a row per spot");
  app.add_option("--evidence", options.evidence, "Write what each decision rested on, for --sweep");
  app.add_option("--sweep", options.sweep, "Read such a file and print what other thresholds would have done");
  app.add_flag_callback(
      "--no-gravity", [&] { options.trial.gravity = false; }, "Requests do not say where up is");
  app.add_flag("--verbose", options.verbose, "Print every spot");
  try {
    app.parse(argc, argv);
    options.trial.evidence = !options.evidence.empty();
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  return liloc::bench::run(options);
}
