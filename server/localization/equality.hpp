#pragma once
// The paper's verification (section 5.3.1): three spots against the device's own motion between them.
#include <array>
#include <optional>

#include "common/geometry/pose.hpp"

namespace liloc {

/// A global registration and the odometry at the same stamp.
struct SpotPose {
  Pose T_map_sensor = Pose::Identity(), T_odom_sensor = Pose::Identity();
};

/// How far two ways to the same pose may differ and still be called equal. The paper gives no values: by hand.
struct EqualityThresholds {
  double angle_rad = radians(5.0);
  double distance_m = 0.20;
};

/// Whether the motion between two spots takes the one's pose to the other's.
[[nodiscard]] bool equal(const SpotPose& a, const SpotPose& b, const EqualityThresholds& thresholds);

enum class Verdict {
  all_agree,      ///< at least two checks hold and so all three spots are tied together
  one_corrected,  ///< one check holds: the third spot was wrong and is corrected by the local transforms
  none            ///< no check holds: no answer
};

struct Verification {
  std::array<bool, 3> checks{};  ///< G2 = L1 G1, G3 = L2 G2, G3 = L2 (L1 G1)
  Verdict verdict = Verdict::none;
  std::optional<std::size_t> wrong;  ///< index of the corrected spot
  std::array<Pose, 3> T_map_sensor;  ///< after correction; as given when the verdict is none
};

[[nodiscard]] Verification verify(const std::array<SpotPose, 3>& spots,
                                  const EqualityThresholds& thresholds = {});

}  // namespace liloc
