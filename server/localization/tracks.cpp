#include "server/localization/tracks.hpp"

#include <algorithm>
#include <numeric>

#include "common/registration/settle.hpp"

namespace liloc {
double Track::total() const {
  return std::accumulate(scores.begin(), scores.end(), 0.0);
}
int Track::supports() const {
  return static_cast<int>(std::count(fits.begin(), fits.end(), true));
}
int Track::own_finds() const {
  return static_cast<int>(std::count(found_own.begin(), found_own.end(), true));
}

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
  bool own = false;
  std::optional<Hypothesis> here;
  for (std::size_t i = 0; i < found.size() && !here; ++i)
    if (same_place(found[i].T_map_sensor(), predicted, options_.gate)) {
      here = found[i];
      (*taken)[i] = true;
      own = true;
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
  track->scores.push_back(here->judgement.score);
  track->found_own.push_back(own);
  track->fits.push_back(stayed && liloc::fits(*here, options_));
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
  track.scores.push_back(hypothesis.judgement.score);
  track.found_own.push_back(true);
  track.fits.push_back(liloc::fits(hypothesis, options_));
  return track;
}

void Tracks::prune() {
  std::stable_sort(tracks_.begin(), tracks_.end(),
                   [](const Track& a, const Track& b) { return a.total() > b.total(); });
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

void Tracks::add(const std::shared_ptr<const Spot>& spot, const std::vector<Hypothesis>& found) {
  spots_.push_back(spot);
  if (spots_.size() > options_.memory) {
    spots_.pop_front();
    for (Track& track : tracks_) {
      track.scores.pop_front();
      track.found_own.pop_front();
      track.fits.pop_front();
    }
  }
  std::vector<bool> taken(found.size(), false);
  for (Track& track : tracks_) extend(&track, *spot, found, &taken);
  for (std::size_t i = 0; i < found.size(); ++i)
    if (!taken[i]) tracks_.push_back(founded(found[i]));
  prune();
}

void Tracks::clear() {
  spots_.clear();
  tracks_.clear();
}

double Tracks::lead() const {
  if (tracks_.empty()) return 0;
  return tracks_.front().total() - (tracks_.size() > 1 ? tracks_[1].total() : 0.0);
}

}  // namespace liloc
