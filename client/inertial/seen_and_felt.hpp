#pragma once
// Private to the room: what was seen and what was felt, side by side. Pure functions.
#include <vector>

#include "client/inertial/motion_record.hpp"

namespace liloc {

/// Rates, or accelerations, seen and felt.
struct Pairs {
  std::vector<Eigen::Vector3d> seen, felt;
  double seconds = 0;  ///< of all steps together
};

struct Fit {
  double factor = 0;   ///< felt over seen
  double squared = 0;  ///< squared correlation, negative where both are opposed
};

/// About the given values. 0 where what was seen has no `least` rms.
[[nodiscard]] Fit fit(const Pairs& pairs, const Eigen::Vector3d& seen_0, const Eigen::Vector3d& felt_0,
                      double least);
[[nodiscard]] Eigen::Vector3d mean(const std::vector<Eigen::Vector3d>& values);

/// That long, or twelve steps where frames are rare. Something was seen.
[[nodiscard]] StampNs window_ns(const MotionRecord& record, StampNs at_least);
/// Whether a step ended less than `window_ns` before the last one that was seen.
[[nodiscard]] bool is_recent(const MotionRecord& record, const SeenStep& step, StampNs window_ns);
/// What was felt over a step, however long, in pieces over which a device turns evenly; empty: not all is
/// known.
[[nodiscard]] std::vector<FeltStep> felt_in_pieces(const MotionRecord& record, const SeenStep& step);

}  // namespace liloc
