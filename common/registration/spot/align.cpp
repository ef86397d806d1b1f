#include "common/registration/spot/align.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <string_view>
#include <utility>

#include "common/base/quantile.hpp"
#include "common/geometry/extent.hpp"
#include "common/geometry/voxel.hpp"
#include "common/registration/points/normals.hpp"
#include "common/registration/spot/spot.hpp"

namespace liloc {
namespace {

// By hand.
// A building; the smallest room is longer in millimetres, and no longer than the second in centimetres. By
// hand.
constexpr double kLargest_m = 500, kLongestRoom_m = 2000;
constexpr std::size_t kFewestPoints = 50, kMostDescribed = 12'000;
// On three scenes of published pairs half and twice the samples find 2 to 4 % fewer of little overlap; of 150
// sketched 1 to 2 % more are found, at 5 ms more; of 20 refined none more.
constexpr int kSamples = 50'000, kSketchIterations = 6;
constexpr std::size_t kKept = 1000, kSketched = 100, kRefined = 16;

Status check(const AlignOptions& options) {
  if (!(options.voxel_size_m >= 0.005 && options.voxel_size_m <= 1.0))
    return fail("voxel is {} m; give 0.005 to 1", options.voxel_size_m);
  if (options.threads < 1) return fail("threads is {}; give at least 1", options.threads);
  if (!(options.risk > 0 && options.risk < 1))
    return fail("risk is {}; give more than 0 and less than 1", options.risk);
  return {};
}

/// Scans in millimetres are the usual mistake; a voxel of metres then holds a point at most.
Status in_metres(std::string_view name, const Cloud& cloud) {
  const double spans_m = extent_m(cloud);
  if (spans_m <= kLargest_m) return {};
  const char* unit = spans_m < kLongestRoom_m       ? "centimetres or millimetres"
                     : 1e-3 * spans_m <= kLargest_m ? "millimetres"
                                                    : "another unit than metres";
  return fail("{} spans {:.4g} m, must be at most {} m: it looks like {}; scale it to metres", name, spans_m,
              kLargest_m, unit);
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

/// `cloud`: thinned, with normals.
Status has_enough(std::string_view name, const Cloud& cloud, double voxel_size_m) {
  if (cloud.size() >= kFewestPoints) return {};
  return fail(
      "{} has {} usable points at a voxel of {} m, of at least {}; give a denser cloud in metres or a larger "
      "voxel",
      name, cloud.size(), voxel_size_m, kFewestPoints);
}

/// Poses of random samples, one of each place.
std::vector<Candidate> sampled(const SpotProblem& problem, const std::vector<FeatureMatch>& matches,
                               double voxel_m) {
  SampleOptions samples;
  samples.sample = Sample::two_normals;
  samples.iterations = kSamples;
  samples.keep = kKept;
  samples.spacing_m = 2 * voxel_m;
  samples.seed = problem.seed;
  return distinct(sample_poses(problem.target->field_fine(), problem.query.sparse.points, matches, samples),
                  kSketched);
}

/// Refines the candidates a little, and the best of them fully.
std::vector<AlignHypothesis> refined(const SpotProblem& problem, const AlignWitness& witness,
                                     std::vector<Candidate> candidates) {
  std::erase_if(candidates, [&](const Candidate& c) { return !witness.possible(c.T_map_sensor); });
  for (Candidate& c : candidates) {
    c.T_map_sensor =
        approach(problem.target, problem.query, c.T_map_sensor, kSketchIterations, problem.judging.refine);
    c.score = witness.sketch_score(c.T_map_sensor);
  }
  std::vector<AlignHypothesis> found;
  for (const Candidate& c : distinct(std::move(candidates), kRefined)) {
    AlignHypothesis h{refine(problem.target, problem.query, c.T_map_sensor, problem.judging.refine), {}, 0};
    h.evidence = witness.of(h.alignment);
    found.push_back(h);
  }
  return found;
}

/// Likeliest first, one of each place.
std::vector<AlignHypothesis> ranked(std::vector<AlignHypothesis> found) {
  for (AlignHypothesis& h : found) h.log_odds = log_odds_of(h.evidence);
  std::ranges::stable_sort(found, std::greater{}, &AlignHypothesis::log_odds);
  std::vector<AlignHypothesis> kept;
  for (const AlignHypothesis& h : found)
    if (std::ranges::none_of(kept, [&](const AlignHypothesis& k) {
          return same_place(k.alignment.T_target_source, h.alignment.T_target_source);
        }))
      kept.push_back(h);
  return kept;
}

}  // namespace

Result<std::vector<AlignHypothesis>> align_hypotheses(const Cloud& source, const Cloud& target,
                                                      const AlignOptions& options) {
  if (const Status status = check(options); !status) return tl::unexpected(status.error());
  const double voxel = options.voxel_size_m;
  for (const auto& [name, cloud] : {std::pair{"source", &source}, {"target", &target}}) {
    if (const Status metres = in_metres(name, *cloud); !metres) return tl::unexpected(metres.error());
    if (const Status near = near_origin(name, *cloud, voxel); !near) return tl::unexpected(near.error());
  }
  const Query query = make_query(source, nullptr, {voxel, 400, options.seed});
  if (const Status enough = has_enough("source", query.cloud, voxel); !enough)
    return tl::unexpected(enough.error());
  Cloud thin = with_normals(voxel_downsample(target, voxel), Eigen::Vector3f::Zero(), {2.5 * voxel, 5});
  if (const Status enough = has_enough("target", thin, voxel); !enough) return tl::unexpected(enough.error());
  const Target room = make_target(std::move(thin), {}, voxel);
  const DescribeOptions describing{10 * voxel, 1.0, options.seed, kMostDescribed, options.describer};
  const auto matches = match_features(describe(query.medium, describing, &query.cloud),
                                      describe(room->coarse, describing, &room->cloud));
  SpotProblem problem{room, query};
  problem.seed = options.seed;
  problem.threads = options.threads;
  problem.judging = judge_options_for(voxel);
  problem.judging.refine.start_distance_m = 0.30;  // samples of features are coarser than a search
  if (options.gravity) problem.up_sensor = Eigen::Vector3d::UnitZ();
  const AlignWitness witness(problem, matches, voxel);
  return ranked(
      refined(problem, witness,
              options.gravity ? GravityProposer().propose(problem) : sampled(problem, matches, voxel)));
}

Result<AlignResult> align_clouds(const Cloud& source, const Cloud& target, const AlignOptions& options) {
  const auto hypotheses = align_hypotheses(source, target, options);
  if (!hypotheses) return tl::unexpected(hypotheses.error());
  AlignResult result;
  if (hypotheses->empty()) return result;
  const AlignHypothesis& best = hypotheses->front();
  result.found = true;
  result.T_target_source = best.alignment.T_target_source;
  result.fitness = best.evidence.fitness;
  result.rmse_m = best.evidence.rmse_m;
  if (hypotheses->size() > 1) result.margin = best.log_odds - (*hypotheses)[1].log_odds;
  std::vector<double> log_odds;
  for (const AlignHypothesis& h : *hypotheses) log_odds.push_back(h.log_odds);
  result.confidence = confidence_of(log_odds);
  result.trusted = result.confidence >= 1 - options.risk;
  return result;
}

}  // namespace liloc
