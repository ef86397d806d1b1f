#pragma once
#include <Eigen/Core>
#include <vector>

#include "common/geometry/pose.hpp"

namespace liloc {

/// Points in one frame, named by the variable (`cloud_sensor`, `gpc_map`). Single precision: a room of 100 m is
/// resolved to 8 micrometres, and twice as many points fit a cache line.
struct Cloud {
  std::vector<Eigen::Vector3f> points;  ///< metres
  std::vector<Eigen::Vector3f>
      normals;  ///< unit, towards the sensor that saw the point; empty or one per point

  [[nodiscard]] std::size_t size() const { return points.size(); }
  [[nodiscard]] bool empty() const { return points.empty(); }
  [[nodiscard]] bool has_normals() const { return !points.empty() && normals.size() == points.size(); }
};

[[nodiscard]] inline Cloud transformed(const Pose& T_to_from, const Cloud& cloud_from) {
  const Eigen::Isometry3f T = T_to_from.cast<float>();
  Cloud moved = cloud_from;
  for (auto& p : moved.points) p = T * p;
  for (auto& n : moved.normals) n = T.linear() * n;
  return moved;
}

/// Both clouds in the same frame. Normals survive only if both sides have them; one without points lacks none.
inline void append(Cloud& to, const Cloud& from) {
  if (from.empty()) return;
  const bool keep_normals = (to.empty() || to.has_normals()) && from.has_normals();
  to.points.insert(to.points.end(), from.points.begin(), from.points.end());
  if (keep_normals)
    to.normals.insert(to.normals.end(), from.normals.begin(), from.normals.end());
  else
    to.normals.clear();
}

}  // namespace liloc
