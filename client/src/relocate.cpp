#include "client/src/relocate.hpp"

#include <algorithm>

#include "common/registration/feature_search.hpp"

namespace liloc {
namespace {

constexpr int kIterations = 20'000;
constexpr std::size_t kProposals = 12, kSparsePoints = 300;
constexpr double kTurnsRad[] = {0.2, -0.2, 0.4, -0.4};  // a match finds its way from half of such a step
constexpr double kStartSdRad = 0.1, kStartSdM = 0.15;   // of a proposal: what three matched points leave open

Cloud cloud_of(const std::vector<Surfel>& frame) {
  Cloud cloud;
  for (const Surfel& s : frame) {
    cloud.points.push_back(s.mean);
    cloud.normals.push_back(s.normal);
  }
  return cloud;
}

Cloud every_nth(const Cloud& cloud, std::size_t most) {
  Cloud thin;
  const std::size_t step = cloud.size() / most + 1;
  for (std::size_t i = 0; i < cloud.size(); i += step) {
    thin.points.push_back(cloud.points[i]);
    thin.normals.push_back(cloud.normals[i]);
  }
  return thin;
}

}  // namespace

std::vector<ScanMatch> relocate(const LocalMap& map, const std::vector<Surfel>& frame, StampNs now_ns,
                                std::uint64_t seed) {
  if (map.size() < 100 || frame.size() < 50) return {};
  const Target target = make_target(map.cloud(), {}, map.cell_m() / 2);
  Query query;
  query.cloud = cloud_of(frame);
  query.medium = query.cloud;
  query.sparse = every_nth(query.cloud, kSparsePoints);
  const DescribeOptions describe_options{.feature_radius_m = 5 * map.cell_m(), .sampling = 0.5, .seed = seed};
  FeatureSearchOptions search;
  search.grid = false;
  search.iterations = kIterations;
  search.propose = kProposals;
  search.seed = seed;
  std::vector<ScanMatch> matches;
  for (const Candidate& candidate : feature_search(target, describe(target->cloud, describe_options), query,
                                                   describe(query.cloud, describe_options), search)) {
    const auto match = match_scan(map, frame, {candidate.T_map_sensor, kStartSdRad, kStartSdM}, now_ns);
    if (match && match->settled) matches.push_back(*match);
  }
  std::stable_sort(matches.begin(), matches.end(),
                   [](const ScanMatch& a, const ScanMatch& b) { return a.overlap > b.overlap; });
  return matches;
}

Result<ScanMatch> match_turned(const LocalMap& map, const std::vector<Surfel>& frame, const MotionGuess& guess,
                               StampNs now_ns) {
  auto best = match_scan(map, frame, guess, now_ns);
  for (const double turn : kTurnsRad) {
    MotionGuess turned = guess;
    turned.T_map_sensor.linear() *= so3_exp({0, turn, 0});
    auto match = match_scan(map, frame, turned, now_ns);
    if (match && match->settled && match->overlap > best->overlap) best = std::move(match);
  }
  return best;
}

}  // namespace liloc
