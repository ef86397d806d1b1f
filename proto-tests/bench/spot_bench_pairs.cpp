#include "proto-tests/bench/spot_bench_pairs.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "common/base/stamp.hpp"
#include "common/registration/spot/align.hpp"
#include "proto-tests/bench/spot_bench_pair_truth.hpp"
#include "proto-tests/bench/spot_bench_tables.hpp"

namespace liloc::bench {
namespace {

constexpr double kSolved_m = 0.2;  // rms of the shared points, as 3DMatch's benchmark counts a pair

struct Solution {
  Cloud shared;  ///< of the source
  Pose T_target_source_true;
  PeerAnswer answer;
  bool trusted = false;
};

void print_line(const std::string& name, const std::vector<Solution>& solutions) {
  std::vector<double> latency;
  std::size_t solved = 0, trusted_wrong = 0;
  for (const Solution& s : solutions) {
    latency.push_back(s.answer.latency_ms);
    const bool right = rmse_m(s.shared, s.answer.T_target_source, s.T_target_source_true) < kSolved_m;
    solved += right;
    trusted_wrong += s.trusted && !right;
  }
  const auto trusted = std::ranges::count_if(solutions, &Solution::trusted);
  if (trusted > 0) fmt::print("{:>22}: {} trusted, of them wrong {}\n", name, trusted, trusted_wrong);
  fmt::print("{:>22}: {} of {} solved, median {:.0f} ms, p90 {:.0f} ms\n", name, solved, solutions.size(),
             percentile(latency, 0.5), percentile(latency, 0.9));
}

}  // namespace

Status run_pairs(const PairsOptions& options) {
  const auto pairs = read_pairs(options.folder + "/gt.log");
  if (!pairs) return tl::unexpected(pairs.error());
  Fragments fragments(options.folder);
  std::vector<Solution> ours, ours_of_theirs, pcl, open3d;
  std::vector<PeerProblem> problems;
  AlignOptions align;
  align.threads = options.threads;
  for (std::size_t i = 0; i < pairs->size(); ++i) {
    const Pair& pair = (*pairs)[i];
    const auto source = fragments.at(pair.source), target = fragments.at(pair.target);
    if (!source) return tl::unexpected(source.error());
    if (!target) return tl::unexpected(target.error());
    const Stopwatch watch;
    const auto aligned = align_clouds((*source)->raw, (*target)->raw, align);
    const double latency_ms = watch.elapsed_ms();
    if (!aligned) return tl::unexpected(aligned.error());
    const Cloud shared = overlapping((*source)->thin, (*target)->thin, pair.T_target_source);
    ours.push_back({shared, pair.T_target_source, {aligned->T_target_source, latency_ms, 0}, aligned->trusted});
    if (rmse_m(shared, aligned->T_target_source, pair.T_target_source) >= kSolved_m)
      fmt::print("not solved: {} in {}{}\n", pair.source, pair.target, aligned->trusted ? ", yet trusted" : "");
    if (options.peer_every == 0 || i % static_cast<std::size_t>(options.peer_every) != 0) continue;
    ours_of_theirs.push_back(ours.back());
    problems.push_back({(*source)->thin, (*target)->thin, pair.T_target_source, 0, i});
    pcl.push_back({shared, pair.T_target_source, ask_pcl(problems.back(), options.threads)});
  }
  fmt::print(
      "\n{} pairs, {} thread(s); LiLoc's time holds the features of both clouds, the peers' those of the "
      "source\n",
      pairs->size(), options.threads);
  print_line("LiLoc, all pairs", ours);
  if (problems.empty()) return {};
  print_line("LiLoc, the peers' pairs", ours_of_theirs);
  print_line("PCL", pcl);
  const auto answers = ask_open3d(problems, options.threads);
  if (!answers) {
    fmt::print("{}\n", answers.error().message);
    return {};
  }
  for (std::size_t i = 0; i < problems.size(); ++i)
    open3d.push_back({pcl[i].shared, problems[i].T_target_source_true, (*answers)[i]});
  print_line("Open3D", open3d);
  return {};
}

}  // namespace liloc::bench
