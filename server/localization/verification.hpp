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
  int spots = 3;               ///< the paper's number
  double lead_per_spot = 0.2;  ///< of the best track over the second, over the spots in memory
  int rival_spots = 2;  ///< that fit another track, all but one of the best's: a room like from two places
  double conclusive_margin = 0.45;   ///< of one spot alone: score over the runner-up's ...
  double conclusive_agree = 0.45;    ///< ... share of device points on seen surfaces ...
  double conclusive_overlap = 0.99;  ///< ... and of those judged, how many agree
  double confirmed_map_agree =
      0.98;                       ///< of several spots: least share of agreeing ceiling points, at first ...
  double confirmed_agree = 0.35;  ///< ... least share of device points on seen surfaces, or a twin of the place
                                  ///< may lie where the ceiling does not look ...
  double verified_map_agree = 0.96;  ///< ... and once they are believed
  double verified_overlap = 0.98;    ///< least share of agreeing among judged device points
  double verified_sd_rad = radians(2.0), verified_sd_m = 0.08;  ///< most, in any direction
  double locked_sd_rad = radians(1.0), locked_sd_m = 0.05;      ///< least, to hold a refinement near its start
  double prior_residual_sd_m = 0.05;                            ///< of a pair of it
  double step_sd_rad = radians(0.2),
         step_sd_m = 0.008;  ///< least growth between spots: calibration and clocks err too
  int patience = 8;  ///< weak spots that nothing contradicts before the device may be believed to be elsewhere
  int research_every = 6;  ///< while tracking, every so many spots the whole room is searched
};

/// What a decision rests on; kept, so that other thresholds can be tried on it without another search.
struct Evidence {
  std::optional<Hypothesis> own;  ///< the spot's own best, where the room was searched
  PoseEstimate own_estimate;
  double margin = 0;               ///< of it over its own runner-up
  std::optional<Hypothesis> best;  ///< at this spot, of the best track or of the pose that was followed
  PoseEstimate best_estimate;
  bool stayed = false;          ///< whether that refinement stayed with its prediction
  int supports = 0;             ///< spots in memory that fit the track, this one among them
  int rival_supports = 0;       ///< the most spots in memory that fit another track
  double lead_per_spot = 0;     ///< of it over the second, in points of score
  std::optional<Reason> chain;  ///< how the paper's checks tie it to the spots' own answers, where they do
};

/// Whether the best track leads so far that its spots may decide; never over another that they fit as well, or
/// the place that the ceiling sees better would win.
[[nodiscard]] bool led(const Evidence& evidence, const VerifyOptions& options);
/// Whether one spot decides alone.
[[nodiscard]] bool conclusive(const Evidence& evidence, const VerifyOptions& options);
/// Whether the spots so far put the device where this one alone does.
[[nodiscard]] bool seconded(const Evidence& evidence, const VerifyOptions& options);
/// Whether several spots decide: confirmed or corrected.
[[nodiscard]] std::optional<Reason> confirmed(const Evidence& evidence, const VerifyOptions& options);
/// Whether a pose that was followed is still verified.
[[nodiscard]] bool holds(const Evidence& evidence, const VerifyOptions& options);
/// Whether lines of sight speak against a pose that was followed. A pose that is merely seen little is not.
[[nodiscard]] bool contradicted(const Evidence& evidence, const VerifyOptions& options);
/// Whether it may be followed further, if only provisionally: nothing speaks against it.
[[nodiscard]] bool follows(const Evidence& evidence, const VerifyOptions& options);

}  // namespace liloc
