#include "proto-tests/bench/spot_bench_pairs.hpp"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <map>

#include "common/base/stamp.hpp"
#include "common/geometry/voxel.hpp"
#include "common/registration/align.hpp"
#include "common/registration/nearest_grid.hpp"
#include "common/registration/normals.hpp"
#include "proto-tests/bench/spot_bench_tables.hpp"
#include "proto-tests/toolbox/cloud_file.hpp"

namespace liloc::bench {
namespace {

constexpr double kVoxel_m = 0.05, kSolved_m = 0.2;

struct Pair {
  int target = 0, source = 0;
  Pose T_target_source = Pose::Identity();
};

Result<std::vector<Pair>> read_pairs(const std::string& path) {
  std::ifstream in(path);
  if (!in) return fail("{}: cannot be read; name a folder that holds a gt.log", path);
  std::vector<Pair> pairs;
  int count = 0;
  for (Pair pair; in >> pair.target >> pair.source >> count; pairs.push_back(pair))
    for (int i = 0; i < 16; ++i) in >> pair.T_target_source.matrix()(i / 4, i % 4);
  if (pairs.empty()) return fail("{}: holds no pair; each is `i j n` and four rows of a matrix", path);
  return pairs;
}

/// The source's points that have a neighbour in the target, at the truth.
Cloud overlapping(const Cloud& source, const Cloud& target, const Pose& T_target_source) {
  const NearestGrid nearest(target.points, 0.4 * kVoxel_m, 1.2 * kVoxel_m);
  Cloud shared;
  for (const Eigen::Vector3f& p : source.points) {
    const Eigen::Vector3f q = T_target_source.cast<float>() * p;
    const std::int32_t j = nearest.nearest(q);
    if (j != NearestGrid::kNone && (q - target.points[static_cast<std::size_t>(j)]).norm() < kVoxel_m)
      shared.points.push_back(p);
  }
  return shared;
}

double rmse_m(const Cloud& points, const Pose& a, const Pose& b) {
  double sum = 0;
  for (const Eigen::Vector3f& p : points.points)
    sum += (a * p.cast<double>() - b * p.cast<double>()).squaredNorm();
  return points.empty() ? 9 : std::sqrt(sum / static_cast<double>(points.size()));
}

struct Solution {
  Cloud shared;  ///< of the source
  Pose T_target_source_true;
  PeerAnswer answer;
};

void print_line(const std::string& name, const std::vector<Solution>& solutions) {
  std::vector<double> latency;
  std::size_t solved = 0;
  for (const Solution& s : solutions) {
    latency.push_back(s.answer.latency_ms);
    solved += rmse_m(s.shared, s.answer.T_target_source, s.T_target_source_true) < kSolved_m;
  }
  fmt::print("{:>22}: {} of {} solved, median {:.0f} ms, p90 {:.0f} ms\n", name, solved, solutions.size(),
             percentile(latency, 0.5), percentile(latency, 0.9));
}

}  // namespace

Status run_pairs(const PairsOptions& options) {
  const auto pairs = read_pairs(options.folder + "/gt.log");
  if (!pairs) return tl::unexpected(pairs.error());
  std::map<int, Cloud> raw, thin;
  for (const Pair& pair : *pairs)
    for (const int i : {pair.target, pair.source}) {
      if (raw.contains(i)) continue;
      auto cloud = toolbox::read_cloud_file(fmt::format("{}/cloud_bin_{}.ply", options.folder, i));
      if (!cloud) return tl::unexpected(cloud.error());
      thin[i] = with_normals(voxel_downsample(*cloud, kVoxel_m), Eigen::Vector3f::Zero());
      raw[i] = std::move(*cloud);
    }
  std::vector<Solution> ours, ours_of_theirs, pcl, open3d;
  std::vector<PeerProblem> problems;
  AlignOptions align;
  align.threads = options.threads;
  for (std::size_t i = 0; i < pairs->size(); ++i) {
    const Pair& pair = (*pairs)[i];
    const Stopwatch watch;
    const auto aligned = align_clouds(raw[pair.source], raw[pair.target], align);
    if (!aligned) return tl::unexpected(aligned.error());
    const Cloud shared = overlapping(thin[pair.source], thin[pair.target], pair.T_target_source);
    ours.push_back({shared, pair.T_target_source, {aligned->T_target_source, watch.elapsed_ms(), 0}});
    if (rmse_m(shared, aligned->T_target_source, pair.T_target_source) >= kSolved_m)
      fmt::print("not solved: {} in {}{}\n", pair.source, pair.target, aligned->trusted ? ", yet trusted" : "");
    if (options.peer_every == 0 || i % static_cast<std::size_t>(options.peer_every) != 0) continue;
    ours_of_theirs.push_back(ours.back());
    problems.push_back({thin[pair.source], thin[pair.target], pair.T_target_source, 0, i});
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
