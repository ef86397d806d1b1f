#include "proto-tests/bench/spot_bench_spots.hpp"

#include <fmt/format.h>

#include <atomic>
#include <mutex>
#include <thread>

#include "proto-tests/bench/spot_bench_misses.hpp"
#include "proto-tests/bench/spot_bench_tables.hpp"
#include "server/tools/command.hpp"

namespace liloc::bench {
namespace {

Result<Stage> open_stage(const SpotsOptions& options, std::size_t index) {
  if (!options.recordings.empty()) return recorded_stage(options.recordings[index]);
  const std::uint64_t seed = options.first_seed + index;
  auto stage = simulated_stage(seed, options.seconds, options.style);
  return stage ? std::move(stage) : fail("site of seed {}: {}", seed, stage.error().message);
}

void print_rows(const std::vector<Row>& rows) {
  for (const Row& r : rows)
    fmt::print("site {} {} {} overlap {:.2f} error {:6.2f} deg {:6.3f} m {} {} margin {:.2f} nees {:.1f} {}\n",
               r.seed, r.reply.client_id, r.cold ? "cold" : "hist", r.overlap, r.error_deg, r.error_m,
               name_of(r.reply.status), name_of(r.reply.reason), r.reply.margin, r.nees, r.reply.text);
}

/// All stages, `jobs` at a time; rows in the order of the stages. Error: the first that a stage met.
Result<TrialResult> run_stages(const SpotsOptions& options) {
  const std::size_t count =
      options.recordings.empty() ? static_cast<std::size_t>(options.sites) : options.recordings.size();
  std::vector<Result<TrialResult>> results(count);
  std::atomic<std::size_t> next{0};
  std::mutex printing;
  std::size_t done = 0;
  toolbox::ProgressBar bar(options.recordings.empty() ? "sites" : "recordings");
  const auto work = [&] {
    for (std::size_t i = next++; i < count; i = next++) {
      auto stage = open_stage(options, i);
      const std::string name = stage ? stage->name : "";
      results[i] = stage ? run_trial(std::move(*stage), options.trial) : tl::unexpected(stage.error());
      const std::scoped_lock lock(printing);
      bar.show(static_cast<double>(++done) / static_cast<double>(count));
      if (!results[i] || !options.verbose) continue;
      fmt::print("{}\n", name);
      print_rows(results[i]->rows);
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
  toolbox::ProgressBar bar("PCL");
  for (const PeerProblem& problem : ours.problems) {
    bar.show(static_cast<double>(pcl.rows.size()) / static_cast<double>(ours.problems.size()));
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

}  // namespace

Result<TrialResult> run_spots(const SpotsOptions& options) {
  auto result = run_stages(options);
  if (!result) return result;
  const std::string what = options.recordings.empty()
                               ? fmt::format("{} sites from seed {}", options.sites, options.first_seed)
                               : fmt::format("{} recordings", options.recordings.size());
  fmt::print("\n{}, {} thread(s), {} job(s), gravity {}\n", what, options.trial.threads, options.jobs,
             options.trial.gravity ? "known" : "unknown");
  print_success(result->rows, true);
  print_success(result->rows, false);
  print_by_site(result->rows);
  print_misses(result->rows);
  print_consistency(result->rows);
  if (options.trial.peer_every > 0) run_peers(*result, options.trial.threads);
  return result;
}

}  // namespace liloc::bench
