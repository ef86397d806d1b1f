#pragma once
// How likely a place is the right one, in logarithms of odds, from what spots say of it and of its rivals.
#include <vector>

#include "common/registration/candidate.hpp"
#include "common/registration/judge.hpp"

namespace liloc {

/// Coefficients of a conditional logit over the places that were found, and one that stands for all others:
/// of greatest likelihood on simulated sites and the recordings, see VERIFICATION.md.
struct BeliefOptions {
  double unseen = 2.6;         ///< weight of the logarithm of how much of the device's cloud nothing bears out
  double least_unseen = 0.05;  ///< so much is never borne out
  double conflict = 1.05;      ///< weight of the logarithm of how much contradicts, over ...
  double few_conflict = 0.0007;  ///< ... what little contradicts the right place too, over device points
  double much_conflict = 0.06;   ///< more than this was never seen at the right place ...
  double beyond = 50;            ///< ... and weighs so much besides, times what is beyond it
  double somewhere = 0.05;  ///< least share of the device's cloud that is borne out, to be a place of its own
  double unfit = 5.6;  ///< for a spot that contradicts the place clearly or that refinement leads away from it
  double elsewhere = -8.1;  ///< of the device being where nothing was found: outside the covered area, say
  PlaceGate view{0.5, radians(20.0)};  ///< how far apart spots begin to see different things
};

/// Whether a place is told from elsewhere at all: where next to nothing of the device's cloud is borne out and
/// nothing contradicts, the ceiling does not look, and one term stands for all such places.
[[nodiscard]] bool is_somewhere(const Judgement& judgement, const BeliefOptions& options);

/// What one spot says for a place.
[[nodiscard]] double evidence_of(const Judgement& judgement, bool fits, const BeliefOptions& options);

/// How much each spot counts, from where odometry says it was: the less, the more others see the same. Sum 1;
/// empty for no spots.
[[nodiscard]] std::vector<double> weights_of(const std::vector<Pose>& T_odom_sensors,
                                             const BeliefOptions& options);

/// Logarithm of the odds of one place against all others and elsewhere. `evidence`: of each place.
[[nodiscard]] double log_odds_of(std::size_t place, const std::vector<double>& evidence,
                                 const BeliefOptions& options);

}  // namespace liloc
