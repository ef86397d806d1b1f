#pragma once
// A pose that was believed, carried from spot to spot: what each spot adds to the belief, and what time takes.
#include <cstdint>

#include "server/localization/confidence.hpp"

namespace liloc {

/// A place that is followed. Plain data; its functions are pure.
struct Followed {
  PoseEstimate estimate;                  ///< at the newest spot
  Pose T_odom_sensor = Pose::Identity();  ///< of that spot
  double log_odds = 0;                    ///< of the place; of the pose within it `estimate` tells
  LookTerms usual;                        ///< what its spots show on average
};

/// What may be kept of a device that is followed, and taken up again by another server or another run of this
/// one.
struct Remembered {
  std::uint32_t odom_segment = 0;
  Followed followed;
};

/// A place that nobody has looked at for so many spots: less sure, and its pose less known. `sd_rad`, `sd_m`:
/// of the motion between two spots, taken to err all the same way.
[[nodiscard]] Followed unwatched(Followed followed, double spots, double sd_rad, double sd_m);

/// A place whose search came to these odds.
[[nodiscard]] Followed begun(const PoseEstimate& estimate, const Pose& T_odom_sensor, double log_odds,
                             const LookTerms& usual);

/// What a spot says of the place it was predicted at: `stayed` tells whether refinement stayed there.
/// `novelty`, 0..1: how much of what it sees no spot before it has seen. That nothing contradicts is worth
/// little, and the less the less is new; what contradicts more than usual counts in full, since devices are
/// lifted and odometry breaks. Once in ten thousand spots that happens unseen.
void note_look(const LookTerms& look, bool stayed, double novelty, Followed* followed);

/// A search of the whole room: it came to the place at odds of its own, or elsewhere.
void note_search(double log_odds, bool elsewhere, Followed* followed);

/// Probability that the followed pose is within 10 degrees and 0.3 m of the truth.
[[nodiscard]] double confidence_of(const Followed& followed);

}  // namespace liloc
