#pragma once
// What a user may choose of verification, and what a decision rests on.
#include <optional>

#include "server/localization/equality.hpp"
#include "server/localization/tracks.hpp"

namespace liloc {

/// Defaults are by hand where nothing else is said.
struct VerifyOptions {
  EqualityThresholds equality;
  TrackOptions tracks;
  double risk = 1e-3;  ///< of all verified answers, the share that may be wrong; see `least_confidence`
  double locked_sd_rad = radians(1.0), locked_sd_m = 0.05;  ///< least, to hold a refinement near its start
  double prior_residual_sd_m = 0.05;                        ///< of a pair of it
  double step_sd_rad = radians(0.2),
         step_sd_m = 0.008;  ///< least growth between spots: calibration and clocks err too
  int research_every = 6;    ///< while following, every so many spots the whole room is searched ...
  int research_latest = 24;  ///< ... or, while others wait for the processor, every so many
};

/// What an answer's confidence must be. Most verified answers are far surer than the least sure one, so that
/// the share of wrong ones is a fifth of what the least sure one risks: on worlds that the model was not fitted
/// on, of those told as at most 0.5 % wrong 0.09 % were by their own word, and none of 1434 was
/// (CONFIDENCE.md).
[[nodiscard]] inline double least_confidence(double risk) {
  return 1 - 5 * risk;
}

/// What the newest search came to; kept, so that other models can be fitted to it without another search.
struct Evidence {
  std::vector<PlaceEvidence> places;  ///< best first; the first has its deviation
  std::vector<Pose> T_map_sensors;    ///< where they have the device
  double log_odds = 0;                ///< of the first
};

}  // namespace liloc
