#include "client/engine/submap.hpp"

#include "common/geometry/depth.hpp"

namespace liloc {

Cloud outside_view(const Cloud& map_odom, const Pose& T_odom_sensor, const SensorView& view,
                   std::size_t most_points) {
  const Eigen::Isometry3f T_sensor_odom = T_odom_sensor.inverse().cast<float>();
  Cloud outside;
  for (std::size_t i = 0; i < map_odom.size(); ++i) {
    const Eigen::Vector3f p = T_sensor_odom * map_odom.points[i];
    const bool from_behind =
        map_odom.has_normals() && (T_sensor_odom.linear() * map_odom.normals[i]).dot(p) >= 0;
    if (p.norm() <= view.max_range_m && !from_behind && !pixel_of(view.camera, p)) outside.points.push_back(p);
  }
  if (outside.size() <= most_points) return outside;
  Cloud thin;
  for (std::size_t i = 0; i < most_points; ++i)
    thin.points.push_back(outside.points[i * outside.size() / most_points]);
  return thin;
}

}  // namespace liloc
