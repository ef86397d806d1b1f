#include "server/localization/confidence.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace liloc {
namespace {

// Of one look; the right place shows 0.07 % of contradiction where sensors are good, and never over 6 % there.
// By hand.
constexpr double kNeverSupported = 0.05, kFewConflicts = 0.0007, kMuchConflict = 0.06;
// A rival recognizes so much of what the place does; less than that is the twin's risk: where the ceiling
// hardly looks, nothing contradicts. 0.4 against 0, 0.1 and 0.25: the least log loss on worlds not fitted on.
constexpr double kRival = 0.4;  // by log loss on held-out worlds, DECISIONS.md
// Below which places are told apart no better; by hand.
constexpr double kFewBits = 3;
constexpr double kLeastSd_m = 0.002, kMostSd_m = 0.5;  // a deviation says no more beyond these; by hand
// What counts as the right place; paper, section 3.1.2.
constexpr double kRight_m = 0.3, kRight_rad = radians(10);
constexpr double kCovarianceScale = 1.3;  // deviations are stated too small by so much (CONFIDENCE.md)

double log_bits(const PlaceEvidence& place) {
  return std::log(place.bits + kFewBits);
}

double clutter_of(const PlaceEvidence& p, const ConfidenceModel::Clutter& c) {
  return c.constant + c.log_agreeing * std::log1p(p.agreeing) + c.contradiction * p.looks.contradiction +
         c.excess * p.looks.excess + c.log_bits * log_bits(p) +
         c.log_sd * std::log(std::clamp(p.sd_m, kLeastSd_m, kMostSd_m) / 0.01);
}

/// How alike the room's places are to each other: what the best rival recognizes of it, over what this place
/// does. A room that repeats itself where the ceiling looks may do so where it does not.
double alike(const std::vector<PlaceEvidence>& places) {
  double most = 0;
  for (std::size_t i = 1; i < places.size(); ++i)
    if (places[i].looks.excess < 0.1) most = std::max(most, places[i].bits);
  return std::min(1.5, most / std::max(places.front().bits, 1.0));
}

double twin_of(const std::vector<PlaceEvidence>& places, const ConfidenceModel::Twin& c) {
  const PlaceEvidence& p = places.front();
  return c.constant + c.share * p.agreeing / std::max(p.searches, 1.0) + c.support * p.looks.support +
         c.contradiction * p.looks.contradiction + c.log_bits * log_bits(p) + c.alike * alike(places);
}

double rather_than(const PlaceEvidence& p, const PlaceEvidence& rival, const ConfidenceModel::Rival& c) {
  return c.constant + c.log_agreeing * (std::log1p(p.agreeing) - std::log1p(rival.agreeing)) +
         c.contradiction * (p.looks.contradiction - rival.looks.contradiction) +
         c.excess * (p.looks.excess - rival.looks.excess) + c.log_bits * (log_bits(p) - log_bits(rival)) +
         c.misfit * (p.looks.misfit - rival.looks.misfit);
}

}  // namespace

const ConfidenceModel& fitted_confidence() {
  static const ConfidenceModel model{.clutter = {.constant = -6.17,
                                                 .log_agreeing = 2.05,
                                                 .contradiction = -0.51,
                                                 .excess = -0.29,
                                                 .log_bits = 2.74,
                                                 .log_sd = -1.03},
                                     .twin = {.constant = 5.46,
                                              .share = 1.77,
                                              .support = 2.75,
                                              .contradiction = -2.35,
                                              .log_bits = 0.84,
                                              .alike = -2.52},
                                     .rival = {.constant = -1.64,
                                               .log_agreeing = 1.40,
                                               .contradiction = -1.70,
                                               .excess = -12.88,
                                               .log_bits = 4.75,
                                               .misfit = -0.81}};
  return model;
}

LookTerms& LookTerms::add(const LookTerms& other, double weight) {
  support += weight * other.support;
  contradiction += weight * other.contradiction;
  excess += weight * other.excess;
  misfit += weight * other.misfit;
  return *this;
}

LookTerms terms_of(const Judgement& judgement, bool fits) {
  const double conflict = judgement.conflict + judgement.map_conflict * judgement.map_seen;
  return {-std::log(1.0 + kNeverSupported - judgement.agree), std::log1p(conflict / kFewConflicts),
          std::max(0.0, conflict - kMuchConflict), fits ? 0.0 : 1.0};
}

double Risks::sum() const {
  return std::accumulate(rivals.begin(), rivals.end(), clutter + twin);
}

Risks risks_of(const std::vector<PlaceEvidence>& places, const ConfidenceModel& model) {
  Risks risks{std::exp(-clutter_of(places.front(), model.clutter)), std::exp(-twin_of(places, model.twin)), {}};
  for (std::size_t i = 1; i < places.size(); ++i)
    risks.rivals.push_back(places[i].bits >= kRival * places.front().bits
                               ? std::exp(-rather_than(places.front(), places[i], model.rival))
                               : 0.0);
  return risks;
}

double log_odds_of(const std::vector<PlaceEvidence>& places, const ConfidenceModel& model) {
  return -std::log(risks_of(places, model).sum());
}

double standing_of(const PlaceEvidence& place) {
  const LookTerms& looks = place.looks;
  return 2.0 * std::log1p(place.agreeing) + 1.6 * log_bits(place) - 1.4 * looks.contradiction -
         0.3 * looks.misfit + 0.3 * looks.support;
}

double probability_of(double log_odds) {
  return 1.0 / (1.0 + std::exp(-log_odds));
}

double log_odds_of_risk(double risk) {
  return std::log((1.0 - risk) / risk);
}

double precision_of(const PoseEstimate& estimate) {
  const auto within = [](double limit, double sd) {
    return sd > 0 ? std::erf(limit / (std::sqrt(2.0) * kCovarianceScale * sd)) : 1.0;
  };
  return within(kRight_m, estimate.sd_m()) * within(kRight_rad, estimate.sd_rad());
}

}  // namespace liloc
