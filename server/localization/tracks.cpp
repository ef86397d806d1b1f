#include "server/localization/tracks.hpp"

#include <algorithm>
#include <numeric>

#include "common/registration/settle.hpp"

namespace liloc {

double bound_share(const Hypothesis& hypothesis) {
  return hypothesis.judgement.agree > 0 ? hypothesis.alignment.pair_share / hypothesis.judgement.agree : 0.0;
}

bool fits(const Hypothesis& hypothesis, const TrackOptions& options) {
  const Judgement& judgement = hypothesis.judgement;
  return judgement.agree >= options.fits_agree && judgement.overlap() >= options.fits_overlap &&
         judgement.map_agree >= options.fits_map_agree && bound_share(hypothesis) >= options.fits_bound;
}

void Tracks::extend(Track* track, const Spot& spot, const std::vector<Hypothesis>& found,
                    std::vector<bool>* taken) const {
  const Pose predicted = track->T_map_odom * spot.T_odom_sensor();
  std::optional<Hypothesis> here;
  for (std::size_t i = 0; i < found.size() && !here; ++i)
    if (same_place(found[i].T_map_sensor(), predicted, options_.gate)) {
      here = found[i];
      (*taken)[i] = true;
    }
  if (!here) {
    here = refine_and_judge(spot.problem(), predicted);
    if (!same_place(here->T_map_sensor(), predicted, options_.gate) || !liloc::fits(*here, options_))
      here = settle(spot.problem(), predicted, std::move(*here));
  }
  const bool stayed = same_place(here->T_map_sensor(), predicted, options_.gate);
  if (stayed)
    track->T_map_odom = here->T_map_sensor() * spot.T_odom_sensor().inverse();
  else
    here->judgement = judge(spot.problem().target, spot.query(), spot.query().medium, predicted,
                            2 * spot.problem().judging.fine_tolerance_m);
  track->latest = *here;
  track->fits = stayed && liloc::fits(*here, options_);
  track->evidence.push_back(evidence_of(here->judgement, track->fits, options_.belief));
}

Track Tracks::founded(const Hypothesis& hypothesis) const {
  Track track;
  const Spot& newest = *spots_.back();
  track.T_map_odom = hypothesis.T_map_sensor() * newest.T_odom_sensor().inverse();
  const Pose T_map_odom = track.T_map_odom;
  std::vector<bool> taken;
  for (std::size_t i = 0; i + 1 < spots_.size(); ++i) {
    extend(&track, *spots_[i], {}, &taken);
    track.T_map_odom = T_map_odom;  // looking back does not move it
  }
  track.latest = hypothesis;
  track.fits = liloc::fits(hypothesis, options_);
  track.evidence.push_back(evidence_of(hypothesis.judgement, track.fits, options_.belief));
  return track;
}

double Tracks::total(const Track& track) const {
  return std::inner_product(weights_.begin(), weights_.end(), track.evidence.begin(), 0.0);
}

void Tracks::prune() {
  std::stable_sort(tracks_.begin(), tracks_.end(),
                   [this](const Track& a, const Track& b) { return total(a) > total(b); });
  const Pose& T_odom_sensor = spots_.back()->T_odom_sensor();
  const PlaceGate wide{2 * options_.gate.distance_m, 2 * options_.gate.angle_rad};
  std::vector<Track> kept;
  for (Track& track : tracks_)
    if (kept.size() < options_.most_tracks && std::none_of(kept.begin(), kept.end(), [&](const Track& k) {
          return same_place(k.T_map_odom * T_odom_sensor, track.T_map_odom * T_odom_sensor, wide);
        }))
      kept.push_back(std::move(track));
  tracks_ = std::move(kept);
}

/// Of the oldest spot that sees what a newer one sees as well, or simply the oldest.
void Tracks::forget_one() {
  const auto repeated = [this](std::size_t i) {
    return std::any_of(
        spots_.begin() + static_cast<std::ptrdiff_t>(i) + 1, spots_.end(), [&](const auto& later) {
          return same_place(spots_[i]->T_odom_sensor(), later->T_odom_sensor(), options_.belief.view);
        });
  };
  std::ptrdiff_t out = 0;
  for (std::size_t i = 0; i < spots_.size(); ++i)
    if (repeated(i)) {
      out = static_cast<std::ptrdiff_t>(i);
      break;
    }
  spots_.erase(spots_.begin() + out);
  for (Track& track : tracks_) track.evidence.erase(track.evidence.begin() + out);
}

void Tracks::add(const std::shared_ptr<const Spot>& spot, const std::vector<Hypothesis>& found) {
  spots_.push_back(spot);
  if (spots_.size() > options_.memory) forget_one();
  std::vector<Pose> T_odom_sensors;
  for (const auto& known : spots_) T_odom_sensors.push_back(known->T_odom_sensor());
  weights_ = weights_of(T_odom_sensors, options_.belief);
  std::vector<bool> taken(found.size(), false);
  for (Track& track : tracks_) extend(&track, *spot, found, &taken);
  for (std::size_t i = 0; i < found.size(); ++i)
    if (!taken[i] && (tracks_.empty() || is_somewhere(found[i].judgement, options_.belief)))
      tracks_.push_back(founded(found[i]));
  prune();
}

void Tracks::clear() {
  spots_.clear();
  tracks_.clear();
}

double Tracks::log_odds() const {
  std::vector<double> evidence;
  for (const Track& track : tracks_) evidence.push_back(total(track));
  return log_odds_of(0, evidence, options_.belief);
}

}  // namespace liloc
