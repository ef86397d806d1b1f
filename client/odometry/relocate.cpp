#include "client/odometry/relocate.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "common/registration/search/feature_search.hpp"

namespace liloc {
namespace {

constexpr int kIterations = 20'000;                          // samples of three points; by hand
constexpr std::size_t kProposals = 12, kSparsePoints = 300;  // by hand
// A match finds its way from half of such a step; by hand, DECISIONS.md.
constexpr double kTurnStepRad = 0.2, kMostTurnRad = 0.8;
constexpr double kShiftStepM = 0.3, kMostShiftM = 0.6;  // by hand, DECISIONS.md
constexpr double kReachSds = 2;                         // of the guess, that starts are spread over; by hand
constexpr double kPriorWeight = 0.01;  // overlap that a match one such deviation off must gain; by hand
// Of a quick match, with so many surfels: twice of both is no better (DECISIONS.md).
constexpr int kQuickIterations = 3;
constexpr std::size_t kQuickSurfels = 100, kFullMatches = 5;
// Of a proposal: what three matched points leave open; by hand.
constexpr double kStartSdRad = 0.1, kStartSdM = 0.15;

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

/// Best first: by overlap, less what the guess says against the match.
void sort_by_merit(std::vector<ScanMatch>& matches, const MotionGuess& guess) {
  const auto merit = [&](const ScanMatch& match) {
    return match.overlap - kPriorWeight * guess.squared_mahalanobis(match.T_map_sensor);
  };
  std::ranges::stable_sort(matches, std::greater{}, merit);
}

/// Numbers of steps to either side that reach as far as the guess may be off.
int steps_to(double reach, double most, double step) {
  return static_cast<int>(std::ceil(std::min(reach, most) / step - 0.5));
}

/// Where matches of all surfels should start, best first.
std::vector<Pose> best_starts(const LocalMap& map, const std::vector<Surfel>& frame, const MotionGuess& guess,
                              StampNs now_ns) {
  const int turns = steps_to(kReachSds * guess.sd_rad(), kMostTurnRad, kTurnStepRad);
  const int shifts = steps_to(kReachSds * guess.sd_m(), kMostShiftM, kShiftStepM);
  ScanMatchOptions quick;
  quick.max_iterations = kQuickIterations;
  quick.max_surfels = kQuickSurfels;
  std::vector<ScanMatch> matches;
  for (int turn = -turns; turn <= turns; ++turn)
    for (int x = -shifts; x <= shifts; ++x)
      for (int z = -shifts; z <= shifts; ++z) {
        Pose T_guess_start = Pose::Identity();
        T_guess_start.linear() = so3_exp({0, kTurnStepRad * turn, 0});
        T_guess_start.translation() = kShiftStepM * Eigen::Vector3d(x, 0, z);
        quick.start = guess.T_map_sensor * T_guess_start;
        if (auto match = match_scan(map, frame, guess, now_ns, quick)) matches.push_back(std::move(*match));
      }
  sort_by_merit(matches, guess);
  std::vector<Pose> starts;
  for (const ScanMatch& match : matches) {
    if (starts.size() == kFullMatches) break;
    const bool known = std::ranges::any_of(starts, [&](const Pose& T) {
      return distance_m(T, match.T_map_sensor) < kShiftStepM / 2 &&
             angle_between_rad(T, match.T_map_sensor) < kTurnStepRad / 2;
    });
    if (!known) starts.push_back(match.T_map_sensor);
  }
  return starts;
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
    if (match && match->converged()) matches.push_back(*match);
  }
  std::stable_sort(matches.begin(), matches.end(),
                   [](const ScanMatch& a, const ScanMatch& b) { return a.overlap > b.overlap; });
  return matches;
}

std::vector<ScanMatch> match_widely(const LocalMap& map, const std::vector<Surfel>& frame,
                                    const MotionGuess& guess, StampNs now_ns) {
  std::vector<ScanMatch> matches;
  for (const Pose& start : best_starts(map, frame, guess, now_ns)) {
    ScanMatchOptions options;
    options.start = start;
    if (auto match = match_scan(map, frame, guess, now_ns, options)) matches.push_back(std::move(*match));
  }
  sort_by_merit(matches, guess);
  return matches;
}

}  // namespace liloc
