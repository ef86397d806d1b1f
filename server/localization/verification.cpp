#include "server/localization/verification.hpp"

namespace liloc {
namespace {

bool sure(const PoseEstimate& estimate, const VerifyOptions& options) {
  return estimate.sd_rad() <= options.verified_sd_rad && estimate.sd_m() <= options.verified_sd_m;
}

}  // namespace

bool conclusive(const Evidence& evidence, const VerifyOptions& options) {
  if (!evidence.own || !fits(*evidence.own, options.tracks)) return false;
  const Judgement& judgement = evidence.own->judgement;
  return judgement.agree >= options.conclusive_agree && judgement.overlap() >= options.conclusive_overlap &&
         judgement.map_agree >= options.conclusive_overlap && evidence.margin >= options.conclusive_margin &&
         sure(evidence.own_estimate, options);
}

bool led(const Evidence& evidence, const VerifyOptions& options) {
  const bool rivalled =
      evidence.rival_supports >= options.rival_spots && evidence.rival_supports >= evidence.supports - 1;
  return !rivalled && evidence.lead_per_spot >= options.lead_per_spot;
}

bool seconded(const Evidence& evidence, const VerifyOptions& options) {
  return evidence.own && evidence.best && led(evidence, options) &&
         same_place(evidence.own->T_map_sensor(), evidence.best->T_map_sensor(), options.tracks.gate);
}

std::optional<Reason> confirmed(const Evidence& evidence, const VerifyOptions& options) {
  const bool enough = evidence.supports >= options.spots && led(evidence, options);
  const bool balance = evidence.best && evidence.best->judgement.score > 0 &&  // more agrees than contradicts
                       evidence.best->judgement.map_agree >= options.confirmed_map_agree &&
                       evidence.best->judgement.agree >= options.confirmed_agree;
  return enough && balance && holds(evidence, options) ? evidence.chain : std::nullopt;
}

bool holds(const Evidence& evidence, const VerifyOptions& options) {
  return follows(evidence, options) && evidence.best->judgement.map_agree >= options.verified_map_agree &&
         evidence.best->judgement.overlap() >= options.verified_overlap &&
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
