#include "server/localization/advice.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string_view>

namespace liloc {
namespace {

// By hand, for words alone: nothing is decided by them.
constexpr double kFewSearches = 3, kLittleSeen = 0.15, kMuchContradicts = 0.02, kLoose_m = 0.08;
constexpr double kNearTwin = 4;  // log odds of the best place over another that is worth naming

/// The likeliest other place, if it is near enough to the best one in odds.
const Pose* twin_of(const Evidence& evidence) {
  if (evidence.places.size() < 2) return nullptr;
  const double rather = log_odds_of({evidence.places[0], evidence.places[1]});
  const double alone = log_odds_of({evidence.places[0]});
  return rather < kNearTwin && alone - rather > 0.7 ? &evidence.T_map_sensors[1] : nullptr;
}

std::string little_seen(const Judgement& judgement, std::string_view remedy) {
  return fmt::format("the ceiling sees {:.0f} % of what the device sees: {}", 100 * judgement.agree, remedy);
}

/// What a spot shows of a pose, with its deviation; none where that is as it should be.
Advised by_look(const Judgement& judgement, double sd_m) {
  if (judgement.conflict + judgement.map_conflict * judgement.map_seen > kMuchContradicts)
    return {Advice::clear_view,
            "lines of sight contradict: somebody close by, or intrinsics or extrinsics that are off"};
  if (sd_m > kLoose_m)
    return {Advice::turn_around, "surfaces hardly hold the pose: turn to where edges or corners are in view"};
  return {};
}

}  // namespace

Advised advice_for(const Evidence& evidence, const Judgement& judgement) {
  if (evidence.places.empty())
    return {Advice::move_on,
            "nothing in the room fits what the device sees: turn or move to where ceiling LiDARs look"};
  const PlaceEvidence& best = evidence.places.front();
  if (judgement.agree < kLittleSeen) {
    const bool wherever = best.searches >= kFewSearches && best.looks.support < -std::log(1.05 - kLittleSeen);
    if (wherever)
      return {Advice::more_coverage, little_seen(judgement, "this place needs more ceiling coverage")};
    return {Advice::turn_around, little_seen(judgement, "turn around or move on")};
  }
  if (const Pose* twin = twin_of(evidence)) {
    const Pose& T = evidence.T_map_sensors.front();
    return {Advice::twin, fmt::format("looks like a place {:.1f} m away, turned by {:.0f} deg: move on",
                                      distance_m(T, *twin), degrees(angle_between_rad(T, *twin)))};
  }
  if (Advised look = by_look(judgement, best.sd_m); look.advice != Advice::none) return look;
  if (best.searches < kFewSearches) return {Advice::wait, "one of few spots so far: ask again"};
  return {Advice::move_on, "not distinct enough yet: move on"};
}

Advised advice_for(const Followed& followed, const Judgement& judgement) {
  if (judgement.agree < kLittleSeen)
    return {Advice::turn_around, little_seen(judgement, "turn around or move on")};
  if (Advised look = by_look(judgement, followed.estimate.sd_m()); look.advice != Advice::none) return look;
  return {Advice::wait, "this spot leaves the pose in doubt: the next one searches the room"};
}

}  // namespace liloc
