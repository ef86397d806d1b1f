#pragma once
// When an answer counts as verified: what is known of it, and the thresholds it is held against.
#include <optional>

#include "server/localization/equality.hpp"
#include "server/localization/pose_filter.hpp"
#include "server/localization/tracks.hpp"

namespace liloc {

/// When an answer counts as verified. Scores are points of `Judgement::score`.
struct VerifyOptions {
  EqualityThresholds equality;
  TrackOptions tracks;
  std::size_t spots = 3;      ///< the paper's number
  double log_odds = 3.4;      ///< least, of a place against all others, to be believed at first ...
  double log_odds_few = 5.0;  ///< ... and while there are fewer spots: what is peculiar to one averages out
  double first_agree = 0.35;  ///< least share of device points on seen surfaces, at first: a twin of the place
                              ///< may lie where the ceiling does not look
  double much_agrees = 0.5;   ///< less than this share makes such a twin likelier ...
  double twin_odds = 10;      ///< ... by so much in the logarithm, times what lacks
  double verified_map_agree = 0.96;  ///< least share of agreeing among judged ceiling points, at first ...
  double verified_overlap = 0.98;    ///< ... and among judged device points
  double followed_map_agree = 0.93, followed_overlap = 0.96;    ///< the same once a pose was believed
  double verified_sd_rad = radians(2.0), verified_sd_m = 0.08;  ///< most, in any direction
  double locked_sd_rad = radians(1.0), locked_sd_m = 0.05;      ///< least, to hold a refinement near its start
  double prior_residual_sd_m = 0.05;                            ///< of a pair of it
  double step_sd_rad = radians(0.2),
         step_sd_m = 0.008;  ///< least growth between spots: calibration and clocks err too
  int patience = 4;  ///< weak spots that nothing contradicts before the device may be believed to be elsewhere
  int research_every = 6;  ///< while tracking, every so many spots the whole room is searched
};

/// What a decision rests on; kept, so that other thresholds can be tried on it without another search.
struct Evidence {
  std::optional<Hypothesis> own;  ///< the spot's own best, where the room was searched
  PoseEstimate own_estimate;
  double own_log_odds = 0;         ///< of it by this spot alone
  double margin = 0;               ///< of its score over its own runner-up's
  std::optional<Hypothesis> best;  ///< at this spot, of the best track or of the pose that was followed
  PoseEstimate best_estimate;
  bool stayed = false;    ///< whether that refinement stayed with its prediction
  double log_odds = 0;    ///< of the best track by all spots in memory ...
  std::size_t spots = 0;  ///< ... of which there are so many
};

/// Whether one spot decides alone.
[[nodiscard]] bool conclusive(const Evidence& evidence, const VerifyOptions& options);
/// Whether the odds of the best track suffice for so many spots. Fewer than `spots` are asked for so much that
/// `twin_odds` would add nothing.
[[nodiscard]] bool led(const Evidence& evidence, const VerifyOptions& options);
/// Whether the spots in memory decide.
[[nodiscard]] bool confirmed(const Evidence& evidence, const VerifyOptions& options);
/// Whether a pose that was followed is still verified: its neighbourhood was weighed already.
[[nodiscard]] bool holds(const Evidence& evidence, const VerifyOptions& options);
/// Whether lines of sight speak against a pose that was followed. A pose that is merely seen little is not.
[[nodiscard]] bool contradicted(const Evidence& evidence, const VerifyOptions& options);
/// Whether it may be followed further, if only provisionally: nothing speaks against it.
[[nodiscard]] bool follows(const Evidence& evidence, const VerifyOptions& options);

}  // namespace liloc
