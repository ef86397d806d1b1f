#include "common/registration/spot/proposers.hpp"

#include <cmath>

#include "common/registration/search/up.hpp"

namespace liloc {
namespace {

constexpr double kContradicts_rad = radians(5.0);  // planes tell up to a degree or two; by hand
// Confidence above which planes may contradict the device; by hand.
constexpr double kSure = 0.5;

}  // namespace

std::vector<UpPair> ups_to_try(const SpotProblem& problem) {
  const std::vector<UpHypothesis> planes = find_up(problem.query.medium);
  std::vector<UpPair> ups;
  if (problem.up_sensor) {
    const bool sure = !planes.empty() && planes.front().confidence > kSure;
    const bool agree = sure && planes.front().up.dot(*problem.up_sensor) >= std::cos(kContradicts_rad);
    ups.push_back({*problem.up_sensor, problem.up_map, agree});
    if (sure && !agree) ups.push_back({planes.front().up, problem.up_map});
    return ups;
  }
  if (!planes.empty()) ups.push_back({planes.front().up, problem.up_map});
  return ups;
}

std::vector<Candidate> GravityProposer::propose(const SpotProblem& problem) const {
  if (!up_ && !problem.up_sensor) return {};
  const UpPair up = up_ ? *up_ : UpPair{*problem.up_sensor, problem.up_map};
  GravitySearchOptions options;
  options.threads = problem.threads;
  options.up_map = up.map;
  options.time_limit = problem.search_limit;
  return gravity_search(problem.target, problem.query, up.sensor, options);
}

std::vector<Candidate> FeatureProposer::propose(const SpotProblem& problem) const {
  FeatureSearchOptions options = options_;
  options.threads = problem.threads;
  options.seed = problem.seed;
  return feature_search(problem.target, problem.target_described(), problem.query, problem.query_described(),
                        options);
}

}  // namespace liloc
