#pragma once
// How probable it is that a place is the right one, from what spots say of it and of its rivals.
#include <vector>

#include "common/registration/spot/judge.hpp"
#include "server/localization/pose_filter.hpp"

namespace liloc {

/// What one spot says of a place, in terms that are averaged over spots.
struct LookTerms {
  double support = 0;        ///< -log(1.05 - share of the device's cloud on surfaces that the ceiling sees)
  double contradiction = 0;  ///< log(1 + share in free space, both ways, over 0.0007)
  double excess = 0;         ///< of that share, what lies beyond 0.06
  double misfit = 0;         ///< 1 where refinement leaves the place or clearly contradicts it

  LookTerms& add(const LookTerms& other, double weight);
};
[[nodiscard]] LookTerms terms_of(const Judgement& judgement, bool fits);

/// All that the recent spots say of a place.
struct PlaceEvidence {
  double agreeing = 0;  ///< of the recent searches, how many came to this place by themselves ...
  double searches = 1;  ///< ... of so many
  LookTerms looks;      ///< mean over views
  double bits = 0;      ///< of the distinct surfaces that were recognized, see SurfaceBits
  double sd_m = 0.01;   ///< largest standard deviation of the pose as surfaces hold it
};

/// Three risks, each a logistic model: that the place is clutter which happened to fit, that the device is in a
/// twin of it which the ceiling does not see, and that it is in one of the other places that were found.
/// Coefficients of greatest likelihood; proto-tests/bench/fit_confidence.py makes them, CONFIDENCE.md tells
/// from what and how well they hold elsewhere.
struct ConfidenceModel {
  struct Clutter {
    double constant, log_agreeing, contradiction, excess, log_bits, log_sd;
  } clutter;
  struct Twin {
    double constant, share, support, contradiction, log_bits, alike;
  } twin;
  struct Rival {
    double constant, log_agreeing, contradiction, excess, log_bits, misfit;
  } rival;
};
[[nodiscard]] const ConfidenceModel& fitted_confidence();

/// What speaks against the first of some places, each as odds against it; their sum is the odds that it is
/// wrong.
struct Risks {
  double clutter = 0, twin = 0;
  std::vector<double> rivals;  ///< one per other place; 0 for one that is no rival
  [[nodiscard]] double sum() const;
};
/// Precondition: not empty.
[[nodiscard]] Risks risks_of(const std::vector<PlaceEvidence>& places,
                             const ConfidenceModel& model = fitted_confidence());
/// Logarithm of the odds that the first of `places` is within 10 degrees and 0.3 m of the truth; the others are
/// its rivals. Precondition: not empty.
[[nodiscard]] double log_odds_of(const std::vector<PlaceEvidence>& places,
                                 const ConfidenceModel& model = fitted_confidence());
/// By which places are ranked, before any deviation is known: an early fit, rounded and fixed, so that later
/// fits meet the same order.
[[nodiscard]] double standing_of(const PlaceEvidence& place);

[[nodiscard]] double probability_of(double log_odds);
[[nodiscard]] double log_odds_of_risk(double risk);
/// Of an estimate in the right place being within 10 degrees and 0.3 m, by its covariance.
[[nodiscard]] double precision_of(const PoseEstimate& estimate);

}  // namespace liloc
