#include "server/localization/equality.hpp"

#include <algorithm>

namespace liloc {
namespace {

/// Where the device was at `to`, going by its own motion from `from`.
Pose carried(const SpotPose& from, const SpotPose& to) {
  return from.T_map_sensor * from.T_odom_sensor.inverse() * to.T_odom_sensor;
}

}  // namespace

bool equal(const SpotPose& a, const SpotPose& b, const EqualityThresholds& thresholds) {
  const Pose expected = carried(a, b);
  return angle_between_rad(expected, b.T_map_sensor) <= thresholds.angle_rad &&
         distance_m(expected, b.T_map_sensor) <= thresholds.distance_m;
}

Verification verify(const std::array<SpotPose, 3>& spots, const EqualityThresholds& thresholds) {
  Verification result;
  result.checks = {equal(spots[0], spots[1], thresholds), equal(spots[1], spots[2], thresholds),
                   equal(spots[0], spots[2], thresholds)};
  for (std::size_t i = 0; i < 3; ++i) result.T_map_sensor[i] = spots[i].T_map_sensor;
  const auto held = std::count(result.checks.begin(), result.checks.end(), true);
  if (held >= 2) {
    result.verdict = Verdict::all_agree;
  } else if (held == 1) {
    result.verdict = Verdict::one_corrected;
    const std::size_t wrong = result.checks[0] ? 2 : result.checks[1] ? 0 : 1;
    const std::size_t right = wrong == 1 ? 2 : 1;  // the agreeing spot nearest in time
    result.wrong = wrong;
    result.T_map_sensor[wrong] = carried(spots[right], spots[wrong]);
  }
  return result;
}

}  // namespace liloc
