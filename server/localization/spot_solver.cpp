#include "server/localization/spot_solver.hpp"

#include <algorithm>
#include <chrono>
#include <functional>
#include <limits>

#include "common/codec/codec.hpp"
#include "common/registration/search/feature_search.hpp"

namespace liloc {
namespace {

// By hand.
constexpr double kLeastSurface_m2 =
    0.375;  // 150 points at 0.05 m: less is a patch of wall that fits everywhere

/// A search that ends here needs no second opinion: much agrees, nothing contradicts, nobody is close.
bool convincing(const std::vector<Hypothesis>& found) {
  return !found.empty() && found.front().judgement.overlap() > 0.97 && found.front().judgement.agree > 0.3 &&
         margin_of(found) > 0.15;
}

/// How features are searched: without gravity by samples of two normals, which find most in least time
/// (common/registration/search/DECISIONS.md). What is kept of a cell is mostly of one place, and as many are
/// proposed as are judged.
FeatureSearchOptions feature_search_of(const SpotProblem& problem, double voxel_size_m) {
  FeatureSearchOptions features;
  if (problem.up_sensor) return features;
  features.sample = Sample::two_normals;
  features.spacing_m = 2 * voxel_size_m;
  features.keep_per_cell = 200;
  features.propose = 60;
  return features;
}

/// Merges two lists of hypotheses, best first, one per place.
std::vector<Hypothesis> merged(std::vector<Hypothesis> a, const std::vector<Hypothesis>& b) {
  for (const Hypothesis& h : b)
    if (std::none_of(a.begin(), a.end(),
                     [&](const Hypothesis& k) { return same_place(k.T_map_sensor(), h.T_map_sensor()); }))
      a.push_back(h);
  std::ranges::stable_sort(a, std::ranges::greater(), &Hypothesis::standing);
  return a;
}

/// The paper's own spot localization: (grid-)RANSAC, ICP, best fitness wins. Its grid drops what lies outside
/// of the cell's bounds.
std::vector<Hypothesis> search_as_paper(const Spot& spot, const LocalizerOptions& options) {
  FeatureSearchOptions features;
  features.grid = options.method == Method::paper || options.method == Method::dynamic_nover;
  features.free_space = false;
  std::vector<Hypothesis> found;
  for (const Candidate& c : FeatureProposer(features).propose(spot.problem())) {
    if (found.size() == spot.problem().judging.refine_most) break;
    found.push_back(refine_and_judge(spot.problem(), c.T_map_sensor));
  }
  if (features.grid) std::erase_if(found, [&](const Hypothesis& h) { return !spot.plausible(h); });
  std::stable_sort(found.begin(), found.end(), [](const Hypothesis& a, const Hypothesis& b) {
    return a.alignment.fitness > b.alignment.fitness;
  });
  return found;
}

}  // namespace

Result<std::shared_ptr<const Spot>> Spot::create(const SpotRequest& request,
                                                 std::shared_ptr<const Snapshot> snapshot,
                                                 const LocalizerOptions& options,
                                                 std::shared_ptr<const CellBounds> bounds,
                                                 const MovingPoints& moving) {
  const auto cloud = decode(request.lpc);
  if (!cloud) return tl::unexpected(cloud.error());
  auto spot = std::make_shared<Spot>();
  spot->request_ = request;
  spot->snapshot_ = std::move(snapshot);
  spot->gpc_stamp_ns_ = spot->snapshot_->stamp_near(request.match_stamp_ns());
  spot->bounds_ = std::move(bounds);
  Cloud extra;
  if (!request.extra.bytes.empty()) {
    if (auto decoded = decode(request.extra))
      extra = std::move(*decoded);
    else
      spot->trouble_ = "surroundings left out: " + decoded.error().message;
  }
  const double fewest = kLeastSurface_m2 / (options.voxel_size_m * options.voxel_size_m);
  const auto take = [&](std::vector<std::uint32_t> left_out) {
    spot->moving_ = std::move(left_out);
    spot->query_ = make_query(*cloud, &request.view.camera, {options.voxel_size_m, 300, options.seed}, extra,
                              spot->moving_);
    return static_cast<double>(spot->query_.cloud.size()) >= fewest;
  };
  // Where too little stands still, what moves is better than nothing.
  if (!take(moving ? moving(*cloud) : std::vector<std::uint32_t>()) && (spot->moving_.empty() || !take({})))
    return fail("the LPC has {} usable points; at least {:.0f} are needed", spot->query_.cloud.size(), fewest);
  for (const auto& p : spot->query_.sparse.points)
    spot->middle_sensor_ += p.cast<double>() / static_cast<double>(spot->query_.sparse.size());
  Spot* raw = spot.get();
  spot->problem_.emplace(
      SpotProblem{spot->snapshot_->target(), spot->query_, request.up_sensor, spot->snapshot_->room()->up_map(),
                  [raw]() -> const Described& { return raw->snapshot_->described(); },
                  [raw, options]() -> const Described& {
                    std::call_once(raw->described_once_, [&] {
                      DescribeOptions describing{10 * options.voxel_size_m, options.sampling, options.seed};
                      describing.describer = options.describer;
                      describing.up = raw->request_.up_sensor;
                      raw->described_ = describe(raw->query_.medium, describing, &raw->query_.cloud);
                    });
                    return raw->described_;
                  },
                  options.seed * 7919 + request.seq, options.threads, judge_options_for(options.voxel_size_m)});
  spot->problem_->search_limit = options.search_limit;
  spot->problem_->judging.refine.point_to_point = options.icp_or_default() == Icp::point;
  return spot;
}

bool Spot::plausible(const Hypothesis& hypothesis) const {
  return !bounds_ || bounds_->plausible(middle_at(hypothesis.T_map_sensor()), hypothesis.alignment.fitness);
}

double margin_of(const std::vector<Hypothesis>& hypotheses) {
  if (hypotheses.empty() || hypotheses.front().judgement.score <= 0) return 0;
  if (hypotheses.size() < 2) return 1;
  double next = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 1; i < hypotheses.size(); ++i) next = std::max(next, hypotheses[i].judgement.score);
  return std::clamp(1.0 - next / hypotheses[0].judgement.score, 0.0, 1.0);
}

RoomSearch search(const Spot& spot, const LocalizerOptions& options) {
  if (options.method != Method::liloc) return {search_as_paper(spot, options)};
  const SpotProblem& problem = spot.problem();
  std::vector<Hypothesis> found;
  for (const UpPair& up : ups_to_try(problem)) {
    const auto began = std::chrono::steady_clock::now();
    const std::vector<Candidate> candidates = GravityProposer(up).propose(problem);
    if (std::chrono::steady_clock::now() - began >= problem.search_limit) return {{}, true};
    found = merged(std::move(found), judge_candidates(problem, candidates));
    if (up.supported && !found.empty()) return {found};  // every place was looked at; features never won there
  }
  if (convincing(found)) return {found};
  const FeatureProposer features(feature_search_of(problem, options.voxel_size_m));
  std::vector<Hypothesis> by_features = judge_candidates(problem, features.propose(problem));
  std::erase_if(by_features, [&](const Hypothesis& h) { return !spot.plausible(h); });
  return {merged(std::move(found), by_features)};
}

}  // namespace liloc
