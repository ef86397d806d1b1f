#include "server/localization/tracks.hpp"

#include <algorithm>
#include <cmath>

#include "common/registration/spot/polish.hpp"

namespace liloc {

double bound_share(const Hypothesis& hypothesis) {
  return hypothesis.judgement.agree > 0 ? hypothesis.alignment.pair_share / hypothesis.judgement.agree : 0.0;
}

bool fits(const Hypothesis& hypothesis, const TrackOptions& options) {
  const Judgement& judgement = hypothesis.judgement;
  return judgement.agree >= options.fits_agree && judgement.overlap() >= options.fits_overlap &&
         judgement.map_agree >= options.fits_map_agree && bound_share(hypothesis) >= options.fits_bound;
}

std::vector<double> weights_of(const std::vector<Pose>& T_odom_sensors, const PlaceGate& view) {
  const auto square = [](double x) { return x * x; };
  std::vector<double> weights;
  double sum = 0;
  for (const Pose& spot : T_odom_sensors) {
    double alike = 0;
    for (const Pose& other : T_odom_sensors)
      alike += std::exp(-square(distance_m(spot, other) / view.distance_m) -
                        square(angle_between_rad(spot, other) / view.angle_rad));
    weights.push_back(1 / alike);
    sum += weights.back();
  }
  for (double& weight : weights) weight /= sum;
  return weights;
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
    if (!same_place(here->T_map_sensor(), predicted, options_.gate) || !fits(*here, options_))
      here = polish(spot.problem(), predicted, std::move(*here));
  }
  const bool stayed = same_place(here->T_map_sensor(), predicted, options_.gate);
  if (stayed)
    track->T_map_odom = here->T_map_sensor() * spot.T_odom_sensor().inverse();
  else
    here->judgement = judge(spot.problem().target, spot.query(), spot.query().medium, predicted,
                            2 * spot.problem().judging.fine_tolerance_m);
  track->latest = *here;
  track->stayed = stayed;
  track->looks.push_back(terms_of(here->judgement, stayed && fits(*here, options_)));
  track->surfaces.add(spot.problem().target, spot.query().medium, stayed ? here->T_map_sensor() : predicted);
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
  track.stayed = true;
  track.looks.push_back(terms_of(hypothesis.judgement, fits(hypothesis, options_)));
  track.surfaces.add(newest.problem().target, newest.query().medium, hypothesis.T_map_sensor());
  return track;
}

PlaceEvidence Tracks::evidence_of(const Track& track) const {
  PlaceEvidence evidence;
  evidence.searches = static_cast<double>(searches_.size());
  evidence.agreeing = static_cast<double>(std::ranges::count_if(searches_, [&](const Searched& search) {
    return same_place(track.T_map_odom * search.T_odom_sensor, search.T_map_sensor, options_.agreement);
  }));
  for (std::size_t i = 0; i < track.looks.size(); ++i) evidence.looks.add(track.looks[i], weights_[i]);
  evidence.bits = track.surfaces.sum();
  return evidence;
}

std::vector<PlaceEvidence> Tracks::evidence(double sd_m) const {
  std::vector<PlaceEvidence> all;
  for (const Track& track : tracks_) all.push_back(evidence_of(track));
  if (!all.empty()) all.front().sd_m = sd_m;
  return all;
}

void Tracks::prune() {
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < tracks_.size(); ++i) order.emplace_back(-standing_of(evidence_of(tracks_[i])), i);
  std::ranges::sort(order);
  const Pose& T_odom_sensor = spots_.back()->T_odom_sensor();
  const PlaceGate wide{2 * options_.gate.distance_m, 2 * options_.gate.angle_rad};
  std::vector<Track> kept;
  for (const auto& [standing, i] : order) {
    const Pose here = tracks_[i].T_map_odom * T_odom_sensor;
    if (kept.size() < options_.most_tracks && std::ranges::none_of(kept, [&](const Track& k) {
          return same_place(k.T_map_odom * T_odom_sensor, here, wide);
        }))
      kept.push_back(std::move(tracks_[i]));
  }
  tracks_ = std::move(kept);
}

/// Of the oldest spot that sees what a newer one sees as well, or simply the oldest.
void Tracks::forget_one() {
  const auto repeated = [this](std::size_t i) {
    return std::any_of(spots_.begin() + static_cast<std::ptrdiff_t>(i) + 1, spots_.end(),
                       [&](const auto& later) {
                         return same_place(spots_[i]->T_odom_sensor(), later->T_odom_sensor(), options_.view);
                       });
  };
  std::ptrdiff_t out = 0;
  for (std::size_t i = 0; i < spots_.size(); ++i)
    if (repeated(i)) {
      out = static_cast<std::ptrdiff_t>(i);
      break;
    }
  spots_.erase(spots_.begin() + out);
  for (Track& track : tracks_) track.looks.erase(track.looks.begin() + out);
}

Tracks::Tracks(TrackOptions options, Memory memory)
    : options_(options),
      spots_(std::move(memory.spots)),
      searches_(std::move(memory.searches)),
      tracks_(std::move(memory.tracks)) {
  weigh();
}

void Tracks::weigh() {
  std::vector<Pose> T_odom_sensors;
  for (const auto& known : spots_) T_odom_sensors.push_back(known->T_odom_sensor());
  weights_ = weights_of(T_odom_sensors, options_.view);
}

void Tracks::add(const std::shared_ptr<const Spot>& spot, const std::vector<Hypothesis>& found) {
  spots_.push_back(spot);
  if (spots_.size() > options_.memory) forget_one();
  weigh();
  searches_.push_back({spot->T_odom_sensor(), found.front().T_map_sensor()});
  if (searches_.size() > options_.searches) searches_.pop_front();
  std::vector<bool> taken(found.size(), false);
  for (Track& track : tracks_) extend(&track, *spot, found, &taken);
  for (std::size_t i = 0; i < found.size(); ++i)
    if (!taken[i] && (tracks_.empty() || found[i].judgement.agree >= options_.somewhere))
      tracks_.push_back(founded(found[i]));
  prune();
}

void Tracks::clear() {
  spots_.clear();
  searches_.clear();
  tracks_.clear();
}

}  // namespace liloc
