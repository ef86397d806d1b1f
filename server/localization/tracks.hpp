#pragma once
// Several answers to "where does odometry lie in the map?", each weighed by all recent spots.
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "common/registration/target/surface_bits.hpp"
#include "server/localization/confidence.hpp"
#include "server/localization/spot_solver.hpp"

namespace liloc {

/// One answer and what each of the last spots says of it.
struct Track {
  Pose T_map_odom = Pose::Identity();
  std::deque<LookTerms> looks;  ///< one per spot in memory, newest last
  SurfaceBits surfaces;         ///< that any spot recognized at this place
  Hypothesis latest;            ///< at the newest spot
  bool stayed = false;          ///< whether the newest spot, refined from it, stays with it
};

/// Defaults are by hand where nothing else is said.
struct TrackOptions {
  std::size_t memory = 5;    ///< spots that are looked back at
  std::size_t searches = 9;  ///< whose own answers are remembered
  std::size_t most_tracks = 6;
  PlaceGate gate{0.25,
                 radians(6.0)};  ///< how far a spot may lie from its prediction; twice that apart are rivals
  PlaceGate agreement{0.15, radians(4.0)};  ///< how near odometry must carry a search's answer to the place
  PlaceGate view{0.5, radians(20.0)};       ///< how far apart spots begin to see different things
  double somewhere = 0.05;                  ///< least share of device points on seen surfaces, to found a track
  double fits_agree = 0.12;                 ///< least share of device points on seen surfaces
  double fits_overlap = 0.93;               ///< least share of agreeing among judged device points
  double fits_map_agree = 0.90;             ///< the same for ceiling points in the device's view
  double fits_bound = 0.5;  ///< least share of agreeing points with a surface along their normal
};

/// Whether free space and surfaces support a pose: points that lie where a surface was seen must also lie
/// along it.
[[nodiscard]] bool fits(const Hypothesis& hypothesis, const TrackOptions& options);
/// Share of the agreeing device points that found a surface with their own normal.
[[nodiscard]] double bound_share(const Hypothesis& hypothesis);
/// How much each spot counts, from where odometry says it was: the less, the more others see the same. Sum 1;
/// empty for no spots.
[[nodiscard]] std::vector<double> weights_of(const std::vector<Pose>& T_odom_sensors, const PlaceGate& view);

/// The tracks of one odometry segment. Each new spot is compared with every track, and each new track with the
/// spots before it, so that all are weighed by the same evidence. Of spots that see the same the older ones are
/// forgotten first. Not thread-safe.
class Tracks {
 public:
  /// A search's own answer.
  struct Searched {
    Pose T_odom_sensor, T_map_sensor;
  };
  /// All that it remembers.
  struct Memory {
    std::deque<std::shared_ptr<const Spot>> spots;
    std::deque<Searched> searches;
    std::vector<Track> tracks;  ///< best first; each has a look per spot
  };

  explicit Tracks(TrackOptions options = {}) : options_(options) {}
  Tracks(TrackOptions options, Memory memory);

  /// `found` are the spot's own hypotheses, best first; at least one.
  void add(const std::shared_ptr<const Spot>& spot, const std::vector<Hypothesis>& found);
  void clear();

  [[nodiscard]] const std::vector<Track>& best_first() const { return tracks_; }
  [[nodiscard]] std::size_t searches() const { return searches_.size(); }
  /// What speaks for each track, best first; the best one's deviation is `sd_m`.
  [[nodiscard]] std::vector<PlaceEvidence> evidence(double sd_m) const;
  [[nodiscard]] Memory memory() const { return {spots_, searches_, tracks_}; }

 private:
  void extend(Track* track, const Spot& spot, const std::vector<Hypothesis>& found,
              std::vector<bool>* taken) const;
  [[nodiscard]] Track founded(const Hypothesis& hypothesis) const;
  [[nodiscard]] PlaceEvidence evidence_of(const Track& track) const;
  void weigh();
  void forget_one();
  void prune();

  TrackOptions options_;
  std::deque<std::shared_ptr<const Spot>> spots_;
  std::vector<double> weights_;  ///< of the spots
  std::deque<Searched> searches_;
  std::vector<Track> tracks_;
};

}  // namespace liloc
