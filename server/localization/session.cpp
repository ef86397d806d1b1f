#include "server/localization/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "common/registration/pose_covariance.hpp"

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
  followed_ = false;
}

bool Session::sure(const PoseEstimate& estimate) const {
  return estimate.sd_rad() <= verify_.verified_sd_rad && estimate.sd_m() <= verify_.verified_sd_m;
}

bool Session::conclusive(const std::vector<Hypothesis>& found) const {
  if (found.empty()) return false;
  const Judgement& best = found.front().judgement;
  return fits(found.front(), verify_.tracks) && best.agree >= verify_.conclusive_agree &&
         best.overlap() >= verify_.conclusive_overlap && best.map_agree >= verify_.conclusive_overlap &&
         margin_of(found) >= verify_.conclusive_margin;
}

void Session::answer(const SpotRequest& request, const std::shared_ptr<const Spot>& spot, SpotReply* reply) {
  if (request.cold) return answer_cold(spot, reply);
  if (!started_ || request.odom_segment != segment_) start_segment(request.odom_segment);
  if (options_.verify_or_default() != Verify::tracks) return answer_as_paper(spot, reply);
  if (estimate_) return answer_tracking(request, spot, reply);
  answer_searching(spot, reply);
}

void Session::answer_cold(const std::shared_ptr<const Spot>& spot, SpotReply* reply) const {
  const auto found = search(*spot, options_);
  if (found.empty()) return conclude(SpotStatus::refused, Reason::not_found, reply);
  const PoseEstimate estimate = estimate_of(*spot, found.front());
  report(found.front(), estimate, margin_of(found), reply);
  if (options_.verify_or_default() == Verify::tracks && conclusive(found) && sure(estimate))
    return conclude(SpotStatus::verified, Reason::conclusive, reply);
  conclude(SpotStatus::provisional, Reason::awaiting_spots, reply);
}

/// Verified or why not yet: the three equality checks among the spots' own answers, and a lead over every
/// rival.
std::optional<Session::Decision> Session::decide(const std::vector<Hypothesis>& found) const {
  if (!followed_ && conclusive(found))  // one spot never outvotes a track that still holds
    return Decision{Reason::conclusive, found.front()};
  const Track& best = tracks_.best_first().front();
  const auto spots = static_cast<double>(tracks_.spots());
  if (best.supports() < verify_.spots || !best.fits.back() || own_answers_.size() < 3) return std::nullopt;
  if (tracks_.lead() < verify_.lead_per_spot * spots) return std::nullopt;
  const Verification v = verify({own_answers_[0], own_answers_[1], own_answers_[2]}, verify_.equality);
  if (v.verdict == Verdict::none) return std::nullopt;
  const SpotPose newest{v.T_map_sensor[2], own_answers_[2].T_odom_sensor};
  const SpotPose tracked{best.T_map_odom * newest.T_odom_sensor, newest.T_odom_sensor};
  if (!equal(tracked, newest, verify_.equality)) return std::nullopt;
  return Decision{v.wrong == std::size_t{2} ? Reason::corrected : Reason::confirmed, best.latest};
}

/// Searches the whole room from this spot and lets all tracks weigh it; locks on and returns why once that is
/// safe.
std::optional<Session::Decision> Session::search_room(const std::shared_ptr<const Spot>& spot,
                                                      std::vector<Hypothesis>* found) {
  *found = search(*spot, options_);
  spots_since_search_ = 0;
  if (found->empty()) return std::nullopt;
  tracks_.add(spot, *found);
  own_answers_.push_back({found->front().T_map_sensor(), spot->T_odom_sensor()});
  if (own_answers_.size() > 3) own_answers_.pop_front();
  last_margin_ = margin_of(*found);
  const auto decision = decide(*found);
  if (!decision) return std::nullopt;
  const PoseEstimate here = estimate_of(*spot, decision->here);
  if (!sure(here)) return std::nullopt;
  // A track that holds has more behind it than this spot's own search; elsewhere, the search is right.
  const bool known = followed_ && same_place(here.T_map_sensor, estimate_->T_map_sensor);
  if (!known) estimate_ = here;
  T_odom_sensor_ = spot->T_odom_sensor();
  weak_in_a_row_ = 0;
  return decision;
}

void Session::answer_searching(const std::shared_ptr<const Spot>& spot, SpotReply* reply) {
  std::vector<Hypothesis> found;
  const auto decision = search_room(spot, &found);
  if (found.empty()) return conclude(SpotStatus::refused, Reason::not_found, reply);
  const Track& best = tracks_.best_first().front();
  const Hypothesis& here = decision ? decision->here : best.fits.back() ? best.latest : found.front();
  report(here, estimate_of(*spot, here), last_margin_, reply);
  if (decision) {
    reply->T_map_odom = estimate_->T_map_sensor * T_odom_sensor_.inverse();
    return conclude(SpotStatus::verified, decision->reason, reply);
  }
  const bool few = tracks_.spots() < static_cast<std::size_t>(verify_.spots);
  const bool led = tracks_.lead() >= verify_.lead_per_spot * static_cast<double>(tracks_.spots());
  conclude(SpotStatus::provisional,
           few   ? Reason::awaiting_spots
           : led ? Reason::inconsistent
                 : Reason::ambiguous,
           reply);
}

/// Refines the predicted pose and weighs the two; true when free space bears the answer out. Otherwise the
/// prediction is the better answer.
bool Session::follow(const SpotRequest& request, const Spot& spot, SpotReply* reply) {
  const Pose T_before_now = T_odom_sensor_.inverse() * request.T_odom_sensor;
  T_odom_sensor_ = request.T_odom_sensor;
  estimate_ = carried(*estimate_, T_before_now, std::max(request.odom_sd_rad, verify_.step_sd_rad),
                      std::max(request.odom_sd_m, verify_.step_sd_m));
  const Pose predicted = estimate_->T_map_sensor;
  // The prior holds what no surface shows and hardly weighs otherwise: the filter weighs afterwards.
  const PosePrior prior{predicted, std::max(estimate_->sd_rad(), verify_.locked_sd_rad),
                        std::max(estimate_->sd_m(), verify_.locked_sd_m), verify_.prior_residual_sd_m};
  const Hypothesis here = refine_and_judge(spot.problem(), predicted, &prior);
  const bool good =
      same_place(here.T_map_sensor(), predicted, verify_.tracks.gate) && fits(here, verify_.tracks);
  if (good) estimate_ = fused(*estimate_, estimate_of(spot, here));
  report(here, *estimate_, last_margin_, reply);
  return good;
}

void Session::answer_tracking(const SpotRequest& request, const std::shared_ptr<const Spot>& spot,
                              SpotReply* reply) {
  const bool good = follow(request, *spot, reply);
  followed_ = good;
  weak_in_a_row_ = good ? 0 : weak_in_a_row_ + 1;
  const bool verified = good && sure(*estimate_);
  conclude(verified ? SpotStatus::verified : SpotStatus::provisional,
           verified ? Reason::confirmed : Reason::weak, reply);
  // Now and then, and as soon as two spots in a row were weak, the whole room is searched again: a device that
  // was lifted and put elsewhere must not be believed for long.
  if (++spots_since_search_ >= verify_.research_every || weak_in_a_row_ >= 2) {
    std::vector<Hypothesis> found;
    if (const auto decision = search_room(spot, &found)) {
      report(decision->here, *estimate_, last_margin_, reply);
      conclude(SpotStatus::verified, decision->reason, reply);
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
