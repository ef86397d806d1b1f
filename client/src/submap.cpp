#include "client/src/submap.hpp"

namespace liloc {
namespace {

bool in_view(const Eigen::Vector3f& p_sensor, const Camera& camera) {
  const Eigen::Vector3d p = p_sensor.cast<double>();
  if (p.z() <= 0) return false;
  const double u = camera.fx * p.x() / p.z() + camera.cx, v = camera.fy * p.y() / p.z() + camera.cy;
  return u > -0.5 && u < camera.width - 0.5 && v > -0.5 && v < camera.height - 0.5;
}

}  // namespace

Cloud outside_view(const Cloud& map_odom, const Pose& T_odom_sensor, const SensorView& view,
                   std::size_t most_points) {
  const Eigen::Isometry3f T_sensor_odom = T_odom_sensor.inverse().cast<float>();
  Cloud outside;
  for (std::size_t i = 0; i < map_odom.size(); ++i) {
    const Eigen::Vector3f p = T_sensor_odom * map_odom.points[i];
    const bool from_behind =
        map_odom.has_normals() && (T_sensor_odom.linear() * map_odom.normals[i]).dot(p) >= 0;
    if (p.norm() <= view.max_range_m && !from_behind && !in_view(p, view.camera)) outside.points.push_back(p);
  }
  if (outside.size() <= most_points) return outside;
  Cloud thin;
  for (std::size_t i = 0; i < most_points; ++i)
    thin.points.push_back(outside.points[i * outside.size() / most_points]);
  return thin;
}

}  // namespace liloc
