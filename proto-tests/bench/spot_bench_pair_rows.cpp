#include "proto-tests/bench/spot_bench_pair_rows.hpp"

#include <fmt/format.h>
#include <fmt/ostream.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <queue>

#include "common/registration/spot/align.hpp"
#include "proto-tests/bench/spot_bench_pair_truth.hpp"

namespace liloc::bench {
namespace {

constexpr int kEveryOther = 6;       // of the pairs that no log names
constexpr double kOverlaps = 0.1;    // as the published benchmarks choose theirs
constexpr std::size_t kFewest = 20;  // shared points; of fewer, all points are asked where they should lie

struct Wanted {
  Pair pair;
  int kind = 0;
};

/// Each cloud's pose in the frame of the first of its chain.
std::map<int, std::pair<int, Pose>> chained(const std::vector<Pair>& pairs) {
  std::map<int, std::vector<std::pair<int, Pose>>> beside;
  for (const Pair& p : pairs) {
    beside[p.target].emplace_back(p.source, p.T_target_source);
    beside[p.source].emplace_back(p.target, p.T_target_source.inverse());
  }
  std::map<int, std::pair<int, Pose>> placed;
  for (const auto& [root, unused] : beside) {
    if (!placed.try_emplace(root, root, Pose::Identity()).second) continue;
    std::queue<int> next({root});
    for (; !next.empty(); next.pop())
      for (const auto& [other, T] : beside[next.front()])
        if (placed.try_emplace(other, root, placed[next.front()].second * T).second) next.push(other);
  }
  return placed;
}

std::vector<Wanted> wanted_of(const std::vector<Pair>& high, const std::vector<Pair>& low) {
  std::vector<Wanted> wanted;
  std::map<std::pair<int, int>, bool> named;
  std::vector<Pair> all;
  for (const auto& [pairs, kind] : {std::pair{&high, 0}, {&low, 1}})
    for (const Pair& p : *pairs) {
      if (named.emplace(std::pair{p.target, p.source}, true).second) wanted.push_back({p, kind});
      all.push_back(p);
    }
  const auto placed = chained(all);
  int others = 0;
  for (const auto& [i, of_i] : placed)
    for (const auto& [j, of_j] : placed)
      if (i < j && of_i.first == of_j.first && !named.contains({i, j}) && ++others % kEveryOther == 0)
        wanted.push_back({{i, j, of_i.second.inverse() * of_j.second}, 3});
  return wanted;
}

}  // namespace

Status write_pair_rows(const std::string& folder, const std::string& file) {
  const auto high = read_pairs(folder + "/gt.log");
  if (!high) return tl::unexpected(high.error());
  const std::string low_log = folder + "/gt_low_overlap.log";
  std::vector<Pair> low;
  if (std::filesystem::exists(low_log)) {
    auto read = read_pairs(low_log);
    if (!read) return tl::unexpected(read.error());
    low = std::move(*read);
  }
  Fragments fragments(folder);
  std::ofstream out(file, std::ios::app);
  for (Wanted& w : wanted_of(*high, low)) {
    const auto source = fragments.at(w.pair.source), target = fragments.at(w.pair.target);
    if (!source) return tl::unexpected(source.error());
    if (!target) return tl::unexpected(target.error());
    Cloud shared = overlapping((*source)->thin, (*target)->thin, w.pair.T_target_source);
    const double overlap = static_cast<double>(shared.size()) / static_cast<double>((*source)->thin.size());
    if (w.kind == 3 && overlap >= kOverlaps) w.kind = 2;
    const auto found = align_hypotheses((*source)->raw, (*target)->raw, {});
    if (!found) return tl::unexpected(found.error());
    if (shared.size() < kFewest) shared = (*source)->thin;
    for (std::size_t rank = 0; rank < found->size(); ++rank) {
      const AlignHypothesis& h = (*found)[rank];
      fmt::print(out, "{},{},{},{},{:.4f},{},{:.4f}", std::filesystem::path(folder).filename().string(), w.kind,
                 w.pair.target, w.pair.source, overlap, rank,
                 rmse_m(shared, h.alignment.T_target_source, w.pair.T_target_source));
      for (const double x : align_regressors(h.evidence)) fmt::print(out, ",{:.5f}", x);
      fmt::print(out, "\n");
    }
    if (found->empty())
      fmt::print(out, "{},{},{},{},{:.4f},-1,9\n", std::filesystem::path(folder).filename().string(), w.kind,
                 w.pair.target, w.pair.source, overlap);
  }
  return {};
}

}  // namespace liloc::bench
