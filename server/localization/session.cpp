#include "server/localization/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/registration/pose_covariance.hpp"
#include "common/registration/settle.hpp"

namespace liloc {
namespace {

void report(const Hypothesis& hypothesis, const PoseEstimate& estimate, double margin, SpotReply* reply) {
  reply->T_map_sensor = estimate.T_map_sensor;
  reply->covariance = estimate.covariance;
  reply->fitness = hypothesis.alignment.fitness;
  reply->inlier_rmse_m = hypothesis.alignment.inlier_rmse_m;
  reply->overlap = hypothesis.judgement.overlap();
  reply->margin = margin;
  const Judgement& j = hypothesis.judgement;
  reply->text = fmt::format("device: {:.0f} % agree, {:.1f} % conflict; ceiling: {:.0f} % agree", 100 * j.agree,
                            100 * j.conflict, 100 * j.map_agree);
}

/// A hypothesis of this spot as an estimate.
PoseEstimate estimate_of(const Spot& spot, const Hypothesis& hypothesis) {
  const Pose& T = hypothesis.T_map_sensor();
  return {T, pose_covariance(spot.problem().target, spot.query(), T)};
}

/// Of the best of a spot's hypotheses against the others, by that spot alone.
double log_odds_alone(const std::vector<Hypothesis>& found, const TrackOptions& options) {
  std::vector<double> evidence;
  for (const Hypothesis& h : found)
    if (evidence.empty() || is_somewhere(h.judgement, options.belief))
      evidence.push_back(evidence_of(h.judgement, fits(h, options), options.belief));
  return log_odds_of(0, evidence, options.belief);
}

/// Whether refinement has left the prediction by more than chance and the judge sees no reason for it: surfaces
/// that hardly hold a pose let it slide.
bool idly_elsewhere(const Spot& spot, const Hypothesis& here, const PoseEstimate& seen,
                    const PoseEstimate& predicted) {
  if (surprise_of(predicted, seen) <= kMostSurprise) return false;
  const Judgement stayed = judge(spot.problem().target, spot.query(), spot.query().medium,
                                 predicted.T_map_sensor, spot.problem().judging.fine_tolerance_m);
  return here.judgement.score < stayed.score + SettleOptions{}.as_good;
}

void conclude(SpotStatus status, Reason reason, SpotReply* reply) {
  reply->status = status;
  reply->reason = reason;
}

}  // namespace

void Session::start_segment(std::uint32_t segment) {
  segment_ = segment;
  started_ = true;
  tracks_.clear();
  own_answers_.clear();
  estimate_.reset();
  weak_in_a_row_ = spots_since_search_ = 0;
  followed_ = doubted_ = false;
}

void Session::answer(const SpotRequest& request, const std::shared_ptr<const Spot>& spot, SpotReply* reply) {
  if (request.cold) return answer_cold(spot, reply);
  if (!started_ || request.odom_segment != segment_) start_segment(request.odom_segment);
  if (options_.verify_or_default() != Verify::tracks) return answer_as_paper(spot, reply);
  if (estimate_) return answer_tracking(request, spot, reply);
  answer_searching(spot, reply);
}

void Session::answer_cold(const std::shared_ptr<const Spot>& spot, SpotReply* reply) {
  const auto found = search(*spot, options_);
  if (found.empty()) return conclude(SpotStatus::refused, Reason::not_found, reply);
  evidence_ = {};
  evidence_.own = found.front();
  evidence_.own_estimate = estimate_of(*spot, found.front());
  evidence_.own_log_odds = log_odds_alone(found, verify_.tracks);
  evidence_.margin = margin_of(found);
  report(found.front(), evidence_.own_estimate, evidence_.margin, reply);
  if (options_.verify_or_default() != Verify::tracks || !conclusive(evidence_, verify_))
    return conclude(SpotStatus::provisional, Reason::awaiting_spots, reply);
  reply->T_map_odom = evidence_.own_estimate.T_map_sensor * spot->T_odom_sensor().inverse();
  conclude(SpotStatus::verified, Reason::conclusive, reply);
}

/// All that the newest spot and the ones before it say of the best track.
Evidence Session::gathered(const Spot& spot, const std::vector<Hypothesis>& found) const {
  const Track& best = tracks_.best_first().front();
  Evidence e;
  e.own = found.front();
  e.own_estimate = estimate_of(spot, found.front());
  e.own_log_odds = log_odds_alone(found, verify_.tracks);
  e.margin = margin_of(found);
  e.best = best.latest;
  e.best_estimate = estimate_of(spot, best.latest);
  e.stayed = best.fits;
  e.log_odds = tracks_.log_odds();
  e.spots = tracks_.spots();
  return e;
}

/// Searches the whole room from this spot and lets all tracks weigh it; locks on and returns why once that is
/// safe. `evidence_` tells what was found. `followed`: what a verified pose looks like here; it competes.
std::optional<Reason> Session::search_room(const std::shared_ptr<const Spot>& spot,
                                           const std::optional<Hypothesis>& followed) {
  std::vector<Hypothesis> found = search(*spot, options_);
  spots_since_search_ = 0;
  evidence_ = {};
  if (found.empty()) return std::nullopt;
  last_margin_ = margin_of(found);
  const auto known = [&](const Hypothesis& h) {
    return same_place(h.T_map_sensor(), followed->T_map_sensor());
  };
  if (followed && std::ranges::none_of(found, known)) found.push_back(*followed);
  tracks_.add(spot, found);
  evidence_ = gathered(*spot, found);
  const bool elsewhere =
      estimate_ && !same_place(evidence_.best_estimate.T_map_sensor, estimate_->T_map_sensor);
  if (!confirmed(evidence_, verify_) || (elsewhere && !followed_ && !doubted_)) return std::nullopt;
  // A track that holds has more behind it than this spot's own search; elsewhere, the search is right.
  if (!followed_ || elsewhere) estimate_ = evidence_.best_estimate;
  T_odom_sensor_ = spot->T_odom_sensor();
  weak_in_a_row_ = 0;
  if (tracks_.spots() == 1) return Reason::conclusive;
  const bool own = same_place(evidence_.own->T_map_sensor(), evidence_.best->T_map_sensor());
  return own ? Reason::confirmed : Reason::corrected;
}

void Session::answer_searching(const std::shared_ptr<const Spot>& spot, SpotReply* reply) {
  const auto why = search_room(spot);
  if (!evidence_.best) return conclude(SpotStatus::refused, Reason::not_found, reply);
  if (why || evidence_.stayed)
    report(*evidence_.best, evidence_.best_estimate, last_margin_, reply);
  else
    report(*evidence_.own, evidence_.own_estimate, last_margin_, reply);
  if (why) {
    reply->T_map_odom = estimate_->T_map_sensor * T_odom_sensor_.inverse();
    return conclude(SpotStatus::verified, *why, reply);
  }
  const bool few = tracks_.spots() < verify_.spots;
  conclude(SpotStatus::provisional,
           few                       ? Reason::awaiting_spots
           : led(evidence_, verify_) ? Reason::inconsistent
                                     : Reason::ambiguous,
           reply);
}

/// Refines the predicted pose and weighs the two; true when that verifies it. Where free space contradicts the
/// refinement the prediction is the better answer.
bool Session::follow(const SpotRequest& request, const Spot& spot, SpotReply* reply) {
  const Pose T_before_now = T_odom_sensor_.inverse() * request.T_odom_sensor;
  T_odom_sensor_ = request.T_odom_sensor;
  estimate_ = carried(*estimate_, T_before_now, std::max(request.odom_sd_rad, verify_.step_sd_rad),
                      std::max(request.odom_sd_m, verify_.step_sd_m));
  const Pose predicted = estimate_->T_map_sensor;
  // The prior holds what no surface shows and hardly weighs otherwise: the filter weighs afterwards.
  const PosePrior prior{predicted, std::max(estimate_->sd_rad(), verify_.locked_sd_rad),
                        std::max(estimate_->sd_m(), verify_.locked_sd_m), verify_.prior_residual_sd_m};
  Hypothesis here = refine_and_judge(spot.problem(), predicted, &prior);
  evidence_ = {};
  evidence_.best = here;
  evidence_.stayed = same_place(here.T_map_sensor(), predicted, verify_.tracks.gate);
  if (!evidence_.stayed || contradicted(evidence_, verify_)) {
    here = settle(spot.problem(), predicted, std::move(here));
    evidence_.best = here;
    evidence_.stayed = same_place(here.T_map_sensor(), predicted, verify_.tracks.gate);
  }
  if (follows(evidence_, verify_)) {
    const PoseEstimate seen = estimate_of(spot, here);
    if (!idly_elsewhere(spot, here, seen, *estimate_)) estimate_ = fused(*estimate_, seen);
  }
  evidence_.best_estimate = *estimate_;
  report(here, *estimate_, last_margin_, reply);
  return holds(evidence_, verify_);
}

void Session::answer_tracking(const SpotRequest& request, const std::shared_ptr<const Spot>& spot,
                              SpotReply* reply) {
  followed_ = follow(request, *spot, reply);
  weak_in_a_row_ = followed_ ? 0 : weak_in_a_row_ + 1;
  if (weak_in_a_row_ == 1) tracks_.clear();  // what odometry tied to the place before may be lost
  doubted_ = contradicted(evidence_, verify_) || weak_in_a_row_ > verify_.patience;
  conclude(followed_ ? SpotStatus::verified : SpotStatus::provisional,
           followed_ ? Reason::confirmed : Reason::weak, reply);
  // Now and then, and as soon as two spots in a row were weak, the whole room is searched again: a device that
  // was lifted and put elsewhere must not be believed for long.
  if (++spots_since_search_ >= verify_.research_every || weak_in_a_row_ >= 2) {
    const Evidence followed = std::exchange(evidence_, {});
    if (const auto why = search_room(spot, followed.best)) {
      report(*evidence_.best, *estimate_, last_margin_, reply);
      conclude(SpotStatus::verified, *why, reply);
    } else {
      evidence_ = followed;
    }
  }
  if (reply->verified()) reply->T_map_odom = estimate_->T_map_sensor * T_odom_sensor_.inverse();
}

void Session::answer_as_paper(const std::shared_ptr<const Spot>& spot, SpotReply* reply) {
  const auto found = search(*spot, options_);
  if (found.empty()) return conclude(SpotStatus::refused, Reason::not_found, reply);
  report(found.front(), estimate_of(*spot, found.front()), margin_of(found), reply);
  const SpotPose own{found.front().T_map_sensor(), spot->T_odom_sensor()};
  if (options_.verify_or_default() == Verify::none) {
    reply->T_map_odom = own.T_map_sensor * own.T_odom_sensor.inverse();
    return conclude(SpotStatus::verified, Reason::confirmed, reply);
  }
  own_answers_.push_back(own);
  if (own_answers_.size() > 3) own_answers_.pop_front();
  if (own_answers_.size() < 3) return conclude(SpotStatus::provisional, Reason::awaiting_spots, reply);
  const Verification v = verify({own_answers_[0], own_answers_[1], own_answers_[2]}, verify_.equality);
  if (v.verdict == Verdict::none) return conclude(SpotStatus::provisional, Reason::inconsistent, reply);
  reply->T_map_odom = v.T_map_sensor[2] * own.T_odom_sensor.inverse();
  reply->T_map_sensor = v.T_map_sensor[2];
  conclude(SpotStatus::verified, v.wrong == std::size_t{2} ? Reason::corrected : Reason::confirmed, reply);
}

}  // namespace liloc
