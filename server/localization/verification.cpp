#include "server/localization/verification.hpp"

#include <algorithm>

namespace liloc {
namespace {

bool sure(const PoseEstimate& estimate, const VerifyOptions& options) {
  return estimate.sd_rad() <= options.verified_sd_rad && estimate.sd_m() <= options.verified_sd_m;
}

bool clean(const Hypothesis& here, const PoseEstimate& estimate, const VerifyOptions& options) {
  return fits(here, options.tracks) && here.judgement.map_agree >= options.verified_map_agree &&
         here.judgement.overlap() >= options.verified_overlap && sure(estimate, options);
}

}  // namespace

bool conclusive(const Evidence& evidence, const VerifyOptions& options) {
  return evidence.own && evidence.own_log_odds >= options.log_odds_few &&
         evidence.own->judgement.agree >= options.first_agree &&
         clean(*evidence.own, evidence.own_estimate, options);
}

bool led(const Evidence& evidence, const VerifyOptions& options) {
  if (!evidence.best) return false;
  if (evidence.spots < options.spots) return evidence.log_odds >= options.log_odds_few;
  const double lacks = std::max(0.0, options.much_agrees - evidence.best->judgement.agree);
  return evidence.log_odds >= options.log_odds + options.twin_odds * lacks;
}

bool confirmed(const Evidence& evidence, const VerifyOptions& options) {
  return led(evidence, options) && follows(evidence, options) &&
         clean(*evidence.best, evidence.best_estimate, options) &&
         evidence.best->judgement.agree >= options.first_agree;
}

bool holds(const Evidence& evidence, const VerifyOptions& options) {
  return follows(evidence, options) && evidence.best->judgement.map_agree >= options.followed_map_agree &&
         evidence.best->judgement.overlap() >= options.followed_overlap &&
         sure(evidence.best_estimate, options);
}

bool contradicted(const Evidence& evidence, const VerifyOptions& options) {
  if (!evidence.best) return false;
  const Judgement& judgement = evidence.best->judgement;
  return (judgement.conflict > 0 && judgement.overlap() < options.verified_overlap) ||
         (judgement.map_conflict > 0 && judgement.map_agree < options.verified_map_agree);
}

bool follows(const Evidence& evidence, const VerifyOptions& options) {
  return evidence.best && evidence.stayed && fits(*evidence.best, options.tracks);
}

}  // namespace liloc
