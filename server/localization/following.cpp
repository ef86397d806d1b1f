#include "server/localization/following.hpp"

#include <algorithm>
#include <cmath>

namespace liloc {
namespace {

constexpr double kHazard = 1e-4;  // per spot, of a break that no spot shows: none in 3541 followed spots
// By logistic regression over 7900 looks at right and wrong places (CONFIDENCE.md), rounded.
constexpr double kContradiction = 1.5, kExcess = 29, kMisfit = 2.0, kLeft = 4.0, kClean = 1.5;
constexpr double kSpread = 0.5;        // of the contradiction of one right look to the next; by hand
constexpr double kFullSupport = 0.35;  // -log(1.05 - 0.35): a third of the cloud on seen surfaces
constexpr double kRepeated = 0.3;      // of what a clean look is worth where nothing in it is new; by hand
constexpr double kUsual = 0.2;         // weight of a new look in the average; by hand
constexpr double kMostAgainst = 6;     // log odds that one look takes at most; by hand

double most() {
  return log_odds_of_risk(kHazard);
}

}  // namespace

Followed begun(const PoseEstimate& estimate, const Pose& T_odom_sensor, double log_odds,
               const LookTerms& usual) {
  return {estimate, T_odom_sensor, std::min(log_odds, most()), usual};
}

Followed unwatched(Followed followed, double spots, double sd_rad, double sd_m) {
  const double survived = probability_of(followed.log_odds) * std::pow(1 - kHazard, spots);
  followed.log_odds = std::min(most(), std::log(survived / (1 - survived)));
  followed.estimate = carried(followed.estimate, Pose::Identity(), spots * sd_rad, spots * sd_m);
  return followed;
}

void note_look(const LookTerms& look, bool stayed, double novelty, Followed* followed) {
  const double survived = probability_of(followed->log_odds) * (1 - kHazard);
  followed->log_odds = std::log(survived / (1 - survived));
  const double unusual = std::max(0.0, look.contradiction - followed->usual.contradiction - kSpread);
  const double against = kContradiction * unusual +
                         kExcess * std::max(0.0, look.excess - followed->usual.excess) +
                         kMisfit * std::max(0.0, look.misfit - followed->usual.misfit) * (unusual > 0 ? 1 : 0) +
                         (stayed ? 0.0 : kLeft);
  const double clean =
      kClean * std::clamp(look.support / kFullSupport, 0.0, 1.0) * (kRepeated + (1 - kRepeated) * novelty);
  followed->log_odds =
      std::min(most(), followed->log_odds + (against > 0 ? -std::min(against, kMostAgainst) : clean));
  if (!stayed || against > 0) return;
  LookTerms usual;
  followed->usual = usual.add(followed->usual, 1 - kUsual).add(look, kUsual);
}

void note_search(double log_odds, bool elsewhere, Followed* followed) {
  if (elsewhere)
    followed->log_odds -= std::max(0.0, log_odds);
  else
    followed->log_odds = std::max(followed->log_odds, std::min(log_odds, most()));
}

double confidence_of(const Followed& followed) {
  return probability_of(followed.log_odds) * precision_of(followed.estimate);
}

}  // namespace liloc
