#include "proto-tests/bench/pair_bench.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "client/odometry/relocate.hpp"
#include "common/base/stamp.hpp"
#include "common/registration/scan/scan_match.hpp"

namespace liloc::bench {
namespace {

constexpr double kGoodRad = 3 / 57.29577951308232, kGoodM = 0.1;  // the 3 deg, 0.1 m of all figures
// Overlap below which turned guesses are tried, and then features.
constexpr double kPoorOverlap = 0.8;
constexpr double kOverlapVoxelM = 0.05;  // as replay measures overlap (truth.cpp)
constexpr double kOverlapping = 0.3;     // pairs with less have little or nothing in common, as behind a hand
constexpr double kGuessSdRad = 0.05, kGuessSdM = 0.05;  // of constant velocity, per two frames

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

std::vector<Surfel> surfels_of(const OdometryFrame& frame, double voxel_m) {
  return extract_surfels(frame.cloud_sensor, Eigen::Vector3f::Zero(), {.size_m = 2 * voxel_m});
}

LocalMap map_of(const OdometryFrame& frame, double voxel_m) {
  LocalMap map({.cell_m = 2 * voxel_m});
  map.insert(Pose::Identity(), surfels_of(frame, voxel_m), 1);
  return map;
}

double overlap_of(const FramePair& pair) {
  const auto match = match_scan(map_of(*pair.target, kOverlapVoxelM), surfels_of(*pair.source, kOverlapVoxelM),
                                {pair.truth(), 1e-4, 1e-4}, 2);
  return match ? match->overlap : 0;
}

}  // namespace

std::vector<FramePair> choose_pairs(const std::string& name, const std::vector<OdometryFrame>& frames, int gap,
                                    std::size_t most) {
  const auto step = static_cast<std::size_t>(gap);
  std::vector<FramePair> pairs;
  if (frames.size() < 2 * step + 1) return pairs;
  const std::size_t count = frames.size() - 2 * step, stride = std::max<std::size_t>(1, count / most);
  for (std::size_t i = step; i + step < frames.size() && pairs.size() < most; i += stride) {
    const OdometryFrame &before = frames[i - step], &target = frames[i];
    pairs.push_back({fmt::format("{}-{}-{}", name, gap, i), gap, &target, &frames[i + step],
                     before.T_odom_sensor.inverse() * target.T_odom_sensor});
    pairs.back().overlap = overlap_of(pairs.back());
  }
  return pairs;
}

PairResult by_liloc(const FramePair& pair, double voxel_m) {
  const Stopwatch watch;
  const LocalMap map = map_of(*pair.target, voxel_m);
  const double doubt = pair.gap / 2.0;
  const auto source = surfels_of(*pair.source, voxel_m);
  const MotionGuess guess(pair.T_target_source_guess, std::min(0.3, kGuessSdRad * doubt),
                          std::min(0.3, kGuessSdM * doubt));
  auto match = match_scan(map, source, guess, 2);
  if (match && match->overlap < kPoorOverlap)
    if (const auto wide = match_widely(map, source, guess, 2); !wide.empty()) match = wide.front();
  if (match && match->overlap < kPoorOverlap) {
    const auto found = relocate(map, source, 2, 1);
    if (!found.empty() && found.front().overlap > match->overlap) match = found.front();
  }
  const Pose T = match ? match->T_map_sensor : pair.T_target_source_guess;
  return {"LiLoc scan match, features",       pair.gap,           distance_m(T, pair.truth()),
          angle_between_rad(T, pair.truth()), watch.elapsed_ms(), pair.overlap};
}

void print_pairs(const std::vector<PairResult>& results) {
  std::map<std::pair<int, std::string>, std::vector<const PairResult*>> groups;
  for (const PairResult& r : results) groups[{r.gap, r.method}].push_back(&r);
  fmt::print("{:4} {:28} {:>6} {:>12} {:>13} {:>11} {:>11} {:>12} {:>12}\n", "gap", "method", "pairs",
             "3 deg 0.1 m", "overlap > 0.3", "median mm", "median deg", "median ms", "p90 ms");
  for (const auto& [key, rows] : groups) {
    std::vector<double> mm, deg, ms;
    double good = 0, overlapping = 0, good_overlapping = 0;
    for (const PairResult* r : rows) {
      mm.push_back(1e3 * r->error_m);
      deg.push_back(degrees(r->error_rad));
      ms.push_back(r->latency_ms);
      const bool right = r->error_m <= kGoodM && r->error_rad <= kGoodRad;
      good += right;
      overlapping += r->overlap > kOverlapping;
      good_overlapping += right && r->overlap > kOverlapping;
    }
    fmt::print("{:4} {:28} {:6} {:11.1f}% {:12.1f}% {:11.1f} {:11.2f} {:12.2f} {:12.2f}\n", key.first,
               key.second, rows.size(), 100 * good / static_cast<double>(rows.size()),
               100 * good_overlapping / std::max(overlapping, 1.0), quantile(mm, 0.5), quantile(deg, 0.5),
               quantile(ms, 0.5), quantile(ms, 0.9));
  }
}

}  // namespace liloc::bench
