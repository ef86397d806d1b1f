#include "server/localization/device_session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/registration/refine/pose_covariance.hpp"
#include "common/registration/spot/polish.hpp"
#include "server/localization/advice.hpp"

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

/// Whether refinement has left the prediction by more than chance and the judge sees no reason for it: surfaces
/// that hardly hold a pose let it slide.
bool idly_elsewhere(const Spot& spot, const Hypothesis& here, const PoseEstimate& seen,
                    const PoseEstimate& predicted) {
  if (squared_mahalanobis(predicted, seen) <= kChiSquareLimit) return false;
  const Judgement stayed = judge(spot.problem().target, spot.query(), spot.query().medium,
                                 predicted.T_map_sensor, spot.problem().judging.fine_tolerance_m);
  return here.judgement.score < stayed.score + PolishOptions{}.as_good;
}

/// How much of a view is new after a motion, 0..1.
double novelty_of(const Pose& motion, const PlaceGate& view) {
  const auto square = [](double x) { return x * x; };
  return 1 - std::exp(-square(motion.translation().norm() / view.distance_m) -
                      square(angle_between_rad(Pose::Identity(), motion) / view.angle_rad));
}

void advise(const Advised& advised, SpotReply* reply) {
  reply->advice = advised.advice;
  reply->text = advised.text + "; " + reply->text;
}

void conclude(SpotStatus status, Reason reason, SpotReply* reply) {
  reply->status = status;
  reply->reason = reason;
}

}  // namespace

std::optional<Remembered> DeviceSession::remembered() const {
  if (!segment_ || !segment_->followed) return std::nullopt;
  return Remembered{segment_->id, *segment_->followed};
}

void DeviceSession::unwatched_for(double spots) {
  if (segment_ && segment_->followed)
    segment_->followed = unwatched(*segment_->followed, spots, verify_.step_sd_rad, verify_.step_sd_m);
}

/// After a search that came to nothing.
void DeviceSession::refuse(const Found& found, SpotReply* reply) {
  const bool cut_off = found.outcome == Found::Outcome::cut_off;
  const Advised advised =
      cut_off ? Advised{Advice::wait,
                        "the search took too long and was cut off: the server is too busy or too slow"}
              : advice_for(found.evidence, {});
  conclude(SpotStatus::refused, cut_off ? Reason::overloaded : Reason::not_found, reply);
  reply->advice = advised.advice;
  reply->text = advised.text;
}

Evidence DeviceSession::answer(const std::shared_ptr<const Spot>& spot, bool spare_time, SpotReply* reply) {
  const SpotRequest& request = spot->request();
  if (request.cold) return answer_cold(spot, reply);
  if (!segment_ || request.odom_segment != segment_->id)
    segment_.emplace(Segment{request.odom_segment, Tracks(verify_.tracks)});
  if (options_.verify_or_default() != Verify::tracks) {
    answer_as_paper(spot, reply);
    return {};
  }
  if (segment_->followed) return answer_following(spot, spare_time, reply);
  return answer_searching(spot, reply);
}

/// Searches the whole room from this spot and lets all tracks weigh it. `followed`: what a believed pose looks
/// like here; it competes.
DeviceSession::Found DeviceSession::search_room(const std::shared_ptr<const Spot>& spot, Tracks* tracks,
                                                const Hypothesis* followed) {
  auto [found, cut_off] = search(*spot, options_);
  Found result;
  if (cut_off) result.outcome = Found::Outcome::cut_off;
  if (found.empty()) return result;
  result.outcome = Found::Outcome::place;
  const double margin = margin_of(found);
  const Pose own = found.front().T_map_sensor();
  const auto known = [&](const Hypothesis& h) {
    return same_place(h.T_map_sensor(), followed->T_map_sensor());
  };
  if (followed != nullptr && std::ranges::none_of(found, known)) found.push_back(*followed);
  tracks->add(spot, found);
  const Track& best = tracks->best_first().front();
  result.best = best.latest;
  result.stayed = best.stayed;
  result.estimate = estimate_of(*spot, best.latest);
  if (!result.stayed) result.estimate.T_map_sensor = best.T_map_odom * spot->T_odom_sensor();
  result.margin = margin;
  result.own = same_place(own, result.estimate.T_map_sensor);
  result.evidence.places = tracks->evidence(result.estimate.sd_m());
  for (const Track& track : tracks->best_first())
    result.evidence.T_map_sensors.push_back(track.T_map_odom * spot->T_odom_sensor());
  result.evidence.log_odds = log_odds_of(result.evidence.places);
  return result;
}

Evidence DeviceSession::answer_cold(const std::shared_ptr<const Spot>& spot, SpotReply* reply) {
  Tracks alone(verify_.tracks);
  Found found = search_room(spot, &alone);
  if (!found) {
    refuse(found, reply);
    return {};
  }
  reply->confidence = probability_of(found.evidence.log_odds);
  report(found.best, found.estimate, found.margin, reply);
  if (options_.verify_or_default() == Verify::tracks && enough(reply->confidence)) {
    reply->T_map_odom = found.estimate.T_map_sensor * spot->T_odom_sensor().inverse();
    conclude(SpotStatus::verified, Reason::conclusive, reply);
  } else {
    advise(advice_for(found.evidence, found.best.judgement), reply);
    conclude(SpotStatus::provisional, Reason::awaiting_spots, reply);
  }
  return std::move(found.evidence);
}

Evidence DeviceSession::answer_searching(const std::shared_ptr<const Spot>& spot, SpotReply* reply) {
  Found found = search_room(spot, &segment_->tracks);
  segment_->spots_since_search = 0;
  if (!found) {
    refuse(found, reply);
    return {};
  }
  report(found.best, found.estimate, found.margin, reply);
  reply->confidence = probability_of(found.evidence.log_odds);
  if (found.stayed && enough(reply->confidence)) {
    segment_->followed = begun(found.estimate, spot->T_odom_sensor(), found.evidence.log_odds, found.looks());
    segment_->weak_in_a_row = 0;
    reply->T_map_odom = found.estimate.T_map_sensor * spot->T_odom_sensor().inverse();
    conclude(SpotStatus::verified,
             segment_->tracks.searches() == 1 ? Reason::conclusive
             : found.own                      ? Reason::confirmed
                                              : Reason::corrected,
             reply);
  } else {
    const Advised advised = advice_for(found.evidence, found.best.judgement);
    advise(advised, reply);
    conclude(SpotStatus::provisional,
             advised.advice == Advice::wait ? Reason::awaiting_spots
             : !found.own                   ? Reason::inconsistent
                                            : Reason::ambiguous,
             reply);
  }
  return std::move(found.evidence);
}

/// Refines the predicted pose and weighs the two; what the spot then shows there. Where free space contradicts
/// the refinement the prediction is the better answer.
Hypothesis DeviceSession::follow(const Spot& spot) {
  const SpotRequest& request = spot.request();
  Followed& followed = *segment_->followed;
  const Pose T_before_now = followed.T_odom_sensor.inverse() * request.T_odom_sensor;
  const double novelty = novelty_of(T_before_now, verify_.tracks.view);
  followed.T_odom_sensor = request.T_odom_sensor;
  followed.estimate =
      carried(followed.estimate, T_before_now, std::max(request.odom_sd_rad, verify_.step_sd_rad),
              std::max(request.odom_sd_m, verify_.step_sd_m));
  const Pose predicted = followed.estimate.T_map_sensor;
  // The prior holds what no surface shows and hardly weighs otherwise: the filter weighs afterwards.
  const PosePrior prior{predicted, std::max(followed.estimate.sd_rad(), verify_.locked_sd_rad),
                        std::max(followed.estimate.sd_m(), verify_.locked_sd_m), verify_.prior_residual_sd_m};
  const auto stays = [&](const Hypothesis& h) {
    return same_place(h.T_map_sensor(), predicted, verify_.tracks.gate);
  };
  Hypothesis here = refine_and_judge(spot.problem(), predicted, &prior);
  if (!stays(here) || !fits(here, verify_.tracks)) here = polish(spot.problem(), predicted, std::move(here));
  const bool stayed = stays(here), fitting = stayed && fits(here, verify_.tracks);
  note_look(terms_of(here.judgement, fitting), stayed, novelty, &followed);
  if (fitting) {
    const PoseEstimate seen = estimate_of(spot, here);
    if (!idly_elsewhere(spot, here, seen, followed.estimate))
      followed.estimate = fused(followed.estimate, seen);
  }
  return here;
}

void DeviceSession::report_followed(const Hypothesis& here, SpotReply* reply) const {
  const Followed& followed = *segment_->followed;
  report(here, followed.estimate, 0, reply);
  reply->confidence = confidence_of(followed);
  reply->T_map_odom.reset();
  if (!enough(reply->confidence)) return conclude(SpotStatus::provisional, Reason::weak, reply);
  reply->T_map_odom = followed.estimate.T_map_sensor * followed.T_odom_sensor.inverse();
  conclude(SpotStatus::verified, Reason::confirmed, reply);
}

/// A search of the whole room beside a pose that is followed: a device that was lifted and put elsewhere must
/// not be believed for long.
DeviceSession::Found DeviceSession::search_beside(const std::shared_ptr<const Spot>& spot,
                                                  const Hypothesis& here, SpotReply* reply) {
  Followed& followed = *segment_->followed;
  segment_->spots_since_search = 0;
  Found found = search_room(spot, &segment_->tracks, &here);
  if (!found) return found;
  const double log_odds = found.evidence.log_odds;
  const bool elsewhere = !same_place(found.estimate.T_map_sensor, followed.estimate.T_map_sensor);
  const bool weak = !reply->verified();
  note_search(log_odds, elsewhere, &followed);
  const bool moved = elsewhere && weak && found.stayed && enough(probability_of(log_odds));
  if (moved) followed = begun(found.estimate, spot->T_odom_sensor(), log_odds, found.looks());
  report_followed(moved ? found.best : here, reply);
  reply->margin = found.margin;
  if (moved && reply->verified()) reply->reason = Reason::corrected;
  return found;
}

/// What a pose in doubt needs at once can wait for spare time where nothing speaks against the pose.
bool DeviceSession::due_for_search(bool spare_time) const {
  const int spots = segment_->spots_since_search;
  return spots >= verify_.research_latest || (spots >= verify_.research_every && spare_time);
}

Evidence DeviceSession::answer_following(const std::shared_ptr<const Spot>& spot, bool spare_time,
                                         SpotReply* reply) {
  const Hypothesis here = follow(*spot);
  report_followed(here, reply);
  int& weak_in_a_row = segment_->weak_in_a_row;
  weak_in_a_row = reply->verified() ? 0 : weak_in_a_row + 1;
  if (weak_in_a_row == 1) segment_->tracks.clear();  // what odometry tied to the place before may be lost
  std::optional<Found> found;
  ++segment_->spots_since_search;
  if (due_for_search(spare_time) || weak_in_a_row >= 2) found = search_beside(spot, here, reply);
  if (!reply->verified()) {
    const bool searched = found && found->outcome != Found::Outcome::cut_off;
    advise(searched ? advice_for(found->evidence, here.judgement)
                    : advice_for(*segment_->followed, here.judgement),
           reply);
    if (segment_->followed->log_odds < 0) segment_->followed.reset();  // likelier wrong than right
  }
  return found ? std::move(found->evidence) : Evidence{};
}

void DeviceSession::answer_as_paper(const std::shared_ptr<const Spot>& spot, SpotReply* reply) {
  const std::vector<Hypothesis> found = search(*spot, options_).found;
  if (found.empty()) return conclude(SpotStatus::refused, Reason::not_found, reply);
  report(found.front(), estimate_of(*spot, found.front()), margin_of(found), reply);
  const SpotPose own{found.front().T_map_sensor(), spot->T_odom_sensor()};
  if (options_.verify_or_default() == Verify::none) {
    reply->T_map_odom = own.T_map_sensor * own.T_odom_sensor.inverse();
    return conclude(SpotStatus::verified, Reason::confirmed, reply);
  }
  auto& answers = segment_->own_answers;
  answers.push_back(own);
  if (answers.size() > 3) answers.pop_front();
  if (answers.size() < 3) return conclude(SpotStatus::provisional, Reason::awaiting_spots, reply);
  const Verification v = verify({answers[0], answers[1], answers[2]}, verify_.equality);
  if (v.verdict == Verdict::none) return conclude(SpotStatus::provisional, Reason::inconsistent, reply);
  reply->T_map_odom = v.T_map_sensor[2] * own.T_odom_sensor.inverse();
  reply->T_map_sensor = v.T_map_sensor[2];
  conclude(SpotStatus::verified, v.wrong == std::size_t{2} ? Reason::corrected : Reason::confirmed, reply);
}

}  // namespace liloc
