#include "client/odometry/pose_source.hpp"

namespace liloc {

std::string_view name_of(PoseSource source) {
  switch (source) {
    case PoseSource::guess:
      return "guess";
    case PoseSource::first:
      return "first";
    case PoseSource::icp:
      return "icp";
    case PoseSource::inertial:
      return "inertial";
    case PoseSource::ransac:
      return "ransac";
    case PoseSource::standing:
      return "standing";
    case PoseSource::external:
      return "external";
  }
  return "unknown";
}

}  // namespace liloc
