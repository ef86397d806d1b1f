#pragma once
// Several answers to "where does odometry lie in the map?", each weighed by all recent spots.
#include <deque>
#include <memory>
#include <vector>

#include "server/localization/spot_solver.hpp"

namespace liloc {

/// One answer and what each of the last spots says of it.
struct Track {
  Pose T_map_odom = Pose::Identity();
  std::deque<double> scores;   ///< one per spot in memory, newest last
  std::deque<bool> found_own;  ///< whether the spot's own search came to it
  std::deque<bool> fits;       ///< whether the spot, refined from it, stays with it and is not contradicted
  Hypothesis latest;           ///< at the newest spot

  [[nodiscard]] double total() const;
  [[nodiscard]] int supports() const;  ///< spots that fit
  [[nodiscard]] int own_finds() const;
};

struct TrackOptions {
  std::size_t memory = 5;  ///< spots
  std::size_t most_tracks = 6;
  PlaceGate gate{0.25,
                 radians(6.0)};  ///< how far a spot may lie from its prediction; twice that apart are rivals
  double fits_agree = 0.12;      ///< least share of device points on seen surfaces
  double fits_overlap = 0.93;    ///< least share of agreeing among judged device points
  double fits_map_agree = 0.90;  ///< the same for ceiling points in the device's view
  double fits_bound = 0.5;       ///< least share of agreeing points with a surface along their normal
};

/// Whether free space and surfaces bear a pose out: points that lie where a surface was seen must also lie
/// along it.
[[nodiscard]] bool fits(const Hypothesis& hypothesis, const TrackOptions& options);
/// Share of the agreeing device points that found a surface with their own normal.
[[nodiscard]] double bound_share(const Hypothesis& hypothesis);

/// The tracks of one odometry segment. Each new spot is compared with every track, and each new track with the
/// spots before it, so that all are weighed by the same evidence. Not thread-safe.
class Tracks {
 public:
  explicit Tracks(TrackOptions options = {}) : options_(options) {}

  /// `found` are the spot's own hypotheses, best first.
  void add(const std::shared_ptr<const Spot>& spot, const std::vector<Hypothesis>& found);
  void clear();

  [[nodiscard]] const std::vector<Track>& best_first() const { return tracks_; }
  [[nodiscard]] std::size_t spots() const { return spots_.size(); }
  /// Total score of the best over that of the second, both over all spots in memory, in points of score.
  [[nodiscard]] double lead() const;

 private:
  void extend(Track* track, const Spot& spot, const std::vector<Hypothesis>& found,
              std::vector<bool>* taken) const;
  [[nodiscard]] Track founded(const Hypothesis& hypothesis) const;
  void prune();

  TrackOptions options_;
  std::deque<std::shared_ptr<const Spot>> spots_;
  std::vector<Track> tracks_;
};

}  // namespace liloc
