#include "client/odometry/match_check.hpp"

#include "common/base/log.hpp"

namespace liloc {
namespace {

constexpr double kWidePriorM = 0.15;  // a guess worse than that does not speak for a match; by hand
// Where nobody moves the image looks through 0.2 % of the map at most. By hand; what they mark: DECISIONS.md.
constexpr double kMovingShare = 0.03, kWrongShare = 0.05;
// With less, a frame from somewhere within a metre fits in many places; by hand.
constexpr double kAmpleOverlap = 0.5;
constexpr double kRefutedWeight = 2;   // overlap that a share of the map seen through takes; by hand
constexpr double kPriorWeight = 0.03;  // and a squared deviation from the guess; by hand

}  // namespace

bool MatchCheck::wide_prior() const {
  return guess_.sd_m() >= kWidePriorM;
}

LocalMap::View MatchCheck::view(const ScanMatch& match) const {
  return map_.compare(match.T_map_sensor, image_, options_.camera, options_.max_range_m);
}

bool MatchCheck::believable(const ScanMatch& match) const {
  const double turned = angle_between_rad(match.T_map_sensor, guess_.T_map_sensor);
  const double moved = distance_m(match.T_map_sensor, guess_.T_map_sensor);
  if (match.overlap < options_.min_overlap || turned > 0.05 + 4 * guess_.sd_rad() ||
      moved > 0.05 + 4 * guess_.sd_m())
    return false;
  return !wide_prior() || consistent(match);
}

bool MatchCheck::consistent(const ScanMatch& match) const {
  const auto seen = view(match);
  log::debug("view: {} agree, {} seen through, {} hidden; overlap {:.2f} of {:.2f}", seen.agree, seen.through,
             seen.hidden, match.overlap, match.paired);
  return match.overlap >= options_.min_overlap_lost && match.overlap >= 0.75 * match.paired &&
         seen.refuted_share() <= options_.max_refuted_share;
}

bool MatchCheck::unhidden(const ScanMatch& match) const {
  const auto seen = view(match);
  return seen.hidden <= seen.agree + seen.through;
}

bool MatchCheck::doubtful(const ScanMatch& match) const {
  if (wide_prior())
    return match.unobserved > 0 || match.overlap < kAmpleOverlap || view(match).refuted_share() > kWrongShare;
  return !match.converged() && view(match).refuted_share() > kMovingShare;
}

double MatchCheck::evidence(const ScanMatch& match) const {
  return match.overlap - kRefutedWeight * view(match).refuted_share();
}

double MatchCheck::merit(const ScanMatch& match) const {
  return evidence(match) - kPriorWeight * guess_.squared_mahalanobis(match.T_map_sensor);
}

}  // namespace liloc
