#pragma once
#include <string_view>

namespace liloc {

/// How the pose of a frame was found.
enum class PoseSource {
  guess,     ///< it was not: the motion model carries on
  first,     ///< the frames begin here
  icp,       ///< matched from the guess
  inertial,  ///< the same, by the inertial method; or dead reckoning
  ransac,    ///< found by features
  standing,  ///< the view has not changed
  external,  ///< somebody else's odometry
};
/// As in local.csv.
[[nodiscard]] std::string_view name_of(PoseSource source);

}  // namespace liloc
