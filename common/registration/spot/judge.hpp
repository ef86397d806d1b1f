#pragma once
#include "common/registration/target/target.hpp"

namespace liloc {

/// What two-way free space says of a candidate pose. Shares are of the points that were asked for.
struct Judgement {
  double agree = 0;         ///< device points on a surface that a ceiling sensor (or the bare target) has
  double conflict = 0;      ///< device points in space that a ceiling sensor looked through
  double map_agree = 0;     ///< ceiling points in the device's view that it measured too, over those in view
  double map_conflict = 0;  ///< ceiling points in space that the device looked through, over those in view
  double map_seen = 0;      ///< ceiling points in the device's view that it could judge, over device points
  double score = 0;         ///< one number for ranking, about -2..2

  /// Share of the device's judged points that agree.
  [[nodiscard]] double overlap() const { return agree + conflict > 0 ? agree / (agree + conflict) : 0.0; }
};

/// A conflict against an agreement, once a pose is refined. By hand: 16 found fewer, 64 as many (DECISIONS.md).
constexpr double kConflictWeight = 32.0;

/// Scores a pose: every proposer's candidates pass through here and nothing else ranks them. `tolerance_m` is
/// how far the pose may still be off. Unseen space is neutral, and so is free space
/// where somebody moves. `map_share`: how many of the target's thinned points are asked; `map_points`: instead
/// of all of them, those that can matter. Pure; cost is linear in both clouds.
[[nodiscard]] Judgement judge(const Target& target, const Query& query, const Cloud& device_points,
                              const Pose& T_map_sensor, double tolerance_m, MapShare map_share = MapShare::all,
                              double conflict_weight = kConflictWeight, const MapPoints* map_points = nullptr);

}  // namespace liloc
