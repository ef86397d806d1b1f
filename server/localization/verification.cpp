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

double lead_needed(const Evidence& evidence, const VerifyOptions& options) {
  return evidence.rival_supports >= evidence.supports ? options.lead_over_fitting : options.lead_per_spot;
}

bool seconded(const Evidence& evidence, const VerifyOptions& options) {
  return evidence.own && evidence.best && evidence.lead_per_spot >= lead_needed(evidence, options) &&
         same_place(evidence.own->T_map_sensor(), evidence.best->T_map_sensor(), options.tracks.gate);
}

std::optional<Reason> confirmed(const Evidence& evidence, const VerifyOptions& options) {
  const bool led =
      evidence.supports >= options.spots && evidence.lead_per_spot >= lead_needed(evidence, options);
  const bool balance = evidence.best && evidence.best->judgement.score > 0 &&  // more agrees than contradicts
                       evidence.best->judgement.map_agree >= options.confirmed_map_agree;
  return led && balance && holds(evidence, options) ? evidence.chain : std::nullopt;
}

bool holds(const Evidence& evidence, const VerifyOptions& options) {
  return follows(evidence, options) && evidence.best->judgement.map_agree >= options.verified_map_agree &&
         evidence.best->judgement.overlap() >= options.verified_overlap &&
         sure(evidence.best_estimate, options);
}

bool follows(const Evidence& evidence, const VerifyOptions& options) {
  return evidence.best && evidence.stayed && fits(*evidence.best, options.tracks);
}

}  // namespace liloc
