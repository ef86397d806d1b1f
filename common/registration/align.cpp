#include "common/registration/align.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "common/base/quantile.hpp"
#include "common/geometry/voxel.hpp"
#include "common/registration/normals.hpp"
#include "common/registration/panorama.hpp"
#include "common/registration/spot.hpp"

namespace liloc {
namespace {

constexpr std::size_t kFewestPoints = 50, kMostDescribed = 12'000;
constexpr double kConflictPairs = 4;  // a point in empty space outweighs so many that fit
// Wrong poses have over 7 % of their points in empty space; right ones 0.2 %, and 2.3 % at most (DECISIONS.md).
constexpr double kMostConflict = 0.05, kMostConflictUnrefined = 0.25;

Status check(const AlignOptions& options) {
  if (!(options.voxel_size_m >= 0.005 && options.voxel_size_m <= 1.0))
    return fail("voxel is {} m; give 0.005 to 1", options.voxel_size_m);
  if (options.threads < 1) return fail("threads is {}; give at least 1", options.threads);
  return {};
}

/// Half of the points must lie where floats tell a tenth of a voxel apart.
Status near_origin(std::string_view name, const Cloud& cloud, double voxel_size_m) {
  std::vector<float> distances_m;
  for (const Eigen::Vector3f& p : cloud.points)
    if (p.allFinite()) distances_m.push_back(p.cwiseAbs().maxCoeff());
  if (distances_m.empty()) return {};
  const double median_m = median(std::move(distances_m));
  const double farthest_m = 0.1 * voxel_size_m / std::numeric_limits<float>::epsilon();
  if (median_m < farthest_m) return {};
  return fail(
      "{} lies {:.3g} m from its origin, where floats are too coarse for a voxel of {} m; move it there", name,
      median_m, voxel_size_m);
}

/// The free space that each of the two clouds shows, where it was seen from its origin.
struct FreeSpace {
  const SpotProblem& problem;
  Panorama source{problem.query.cloud.points}, target{problem.target->cloud.points};

  [[nodiscard]] Panorama::Count count(const Pose& T_target_source, double tolerance_m) const {
    Panorama::Count sum;
    const auto add = [&](const Panorama& seen, const Cloud& points, const Pose& T) {
      if (!seen.seen_from_origin()) return;
      const Panorama::Count count = seen.count(points.points, T, tolerance_m);
      sum.conflict += count.conflict;
      sum.known += count.known;
    };
    add(target, problem.query.medium, T_target_source);
    add(source, problem.target->coarse, T_target_source.inverse());
    return sum;
  }
};

/// `cloud`: thinned, with normals.
Status has_enough(std::string_view name, const Cloud& cloud, double voxel_size_m) {
  if (cloud.size() >= kFewestPoints) return {};
  return fail(
      "{} has {} usable points at a voxel of {} m, of at least {}; give a denser cloud or a larger voxel", name,
      cloud.size(), voxel_size_m, kFewestPoints);
}

struct Ranked {
  Hypothesis hypothesis;
  Fit fit;
  Panorama::Count space;
  [[nodiscard]] double score() const { return hypothesis.alignment.pairs - kConflictPairs * space.conflict; }
};

/// The number of points that fit, normals too, less those that lie where the other cloud shows nothing.
std::vector<Ranked> rank(const SpotProblem& problem, std::vector<Candidate> candidates, double voxel_m) {
  const FreeSpace space{problem};
  std::erase_if(candidates, [&](const Candidate& c) {
    const auto count = space.count(c.T_map_sensor, 3 * voxel_m + problem.judging.refine.start_distance_m);
    return count.conflict > kMostConflictUnrefined * count.known;
  });
  std::vector<Ranked> ranked;
  for (const Hypothesis& h : judge_candidates(problem, std::move(candidates)))
    ranked.push_back({h, fit_of(problem.target, problem.query.cloud, h.T_map_sensor(), 1.5 * voxel_m),
                      space.count(h.T_map_sensor(), 3 * voxel_m)});
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Ranked& a, const Ranked& b) { return a.score() > b.score(); });
  return ranked;
}

}  // namespace

Result<AlignResult> align_clouds(const Cloud& source, const Cloud& target, const AlignOptions& options) {
  if (const Status status = check(options); !status) return tl::unexpected(status.error());
  const double voxel = options.voxel_size_m;
  for (const auto& [name, cloud] : {std::pair{"source", &source}, {"target", &target}})
    if (const Status near = near_origin(name, *cloud, voxel); !near) return tl::unexpected(near.error());
  const Query query = make_query(source, nullptr, {voxel, 400, options.seed});
  if (const Status enough = has_enough("source", query.cloud, voxel); !enough)
    return tl::unexpected(enough.error());
  Cloud thin = with_normals(voxel_downsample(target, voxel), Eigen::Vector3f::Zero(), {2.5 * voxel, 5});
  if (const Status enough = has_enough("target", thin, voxel); !enough) return tl::unexpected(enough.error());
  const Target room = make_target(std::move(thin), {}, voxel);
  const Described room_described = describe(room->coarse, {10 * voxel, 1.0, options.seed, kMostDescribed});
  const Described query_described = describe(query.medium, {10 * voxel, 1.0, options.seed, kMostDescribed});
  SpotProblem problem{room, query};
  problem.target_described = [&]() -> const Described& { return room_described; };
  problem.query_described = [&]() -> const Described& { return query_described; };
  problem.seed = options.seed;
  problem.threads = options.threads;
  problem.judging = judge_options_for(voxel);
  problem.judging.refine.start_distance_m = 0.30;  // samples of three features are coarser than a search
  problem.judging.sketch_most = 100;
  problem.judging.refine_most = problem.judging.keep = 20;
  if (options.gravity) problem.up_sensor = Eigen::Vector3d::UnitZ();
  FeatureSearchOptions features;
  features.grid = false;
  features.iterations = 200000;
  features.keep_per_cell = 300;
  features.propose = 100;
  const auto ranked = rank(
      problem,
      options.gravity ? GravityProposer().propose(problem) : FeatureProposer(features).propose(problem), voxel);
  AlignResult result;
  if (ranked.empty()) return result;
  const Ranked& best = ranked.front();
  result.T_target_source = best.hypothesis.T_map_sensor();
  result.fitness = best.fit.fitness;
  result.rmse_m = best.fit.inlier_rmse_m;
  if (best.score() > 0)
    result.margin = ranked.size() > 1 ? std::min(1.0, 1.0 - ranked[1].score() / best.score()) : 1.0;
  result.trusted = result.fitness >= 0.25 && result.margin >= 0.20 && best.hypothesis.alignment.pairs >= 100 &&
                   best.space.conflict <= kMostConflict * best.space.known;
  return result;
}

}  // namespace liloc
