#pragma once
// Private to the room: what requests and replies have in common, to the wire and, checked, from it.
#include <liloc.h>

#include "common/wire/dds/convert.hpp"

namespace liloc::wire {

inline liloc_msg_Transform to_wire(const Pose& T) {
  const Eigen::Quaterniond q(T.linear());
  return {{T.translation().x(), T.translation().y(), T.translation().z()}, {q.x(), q.y(), q.z(), q.w()}};
}

inline Result<Pose> pose_of(const liloc_msg_Transform& T, std::string_view what) {
  return valid_pose(Eigen::Map<const Eigen::Vector3d>(T.translation_m),
                    Eigen::Map<const Eigen::Vector4d>(T.rotation_xyzw), what);
}

/// The first error of several checks.
template <class... Checks>
Status all_of(Checks&&... checks) {
  Status status;
  ((status = status ? Status(std::forward<Checks>(checks)) : status), ...);
  return status;
}

inline Status stamp_of(std::int64_t stamp_ns, std::string_view what) {
  if (stamp_ns < 0) return fail("{} is {}, must not be negative", what, stamp_ns);
  return {};
}

}  // namespace liloc::wire
