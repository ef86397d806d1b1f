#include "proto-tests/sim/motion/people.hpp"

#include <cmath>

namespace liloc::sim {

using Eigen::Vector3d;

Body Body::person(Random& random) {
  const double height = random.uniform(1.58, 1.9), hip = 0.52 * height, shoulder = 0.82 * height;
  const double broad = random.uniform(0.19, 0.24), deep = random.uniform(0.11, 0.16);
  Body body;
  Mesh trunk;
  add_ellipsoid(trunk, {0, 0, 0.5 * (hip + shoulder)}, {deep, broad, 0.62 * (shoulder - hip)}, 8);
  add_ellipsoid(trunk, {0, 0, 0.935 * height}, {0.1, 0.085, 0.065 * height}, 7,
                Material::dark);  // hair returns little
  add_cylinder(trunk, {0, 0, shoulder - 0.03}, 0.055, 0.05, 0.1, 8);
  body.parts_.push_back(std::move(trunk));
  body.joints_.emplace_back(Vector3d::Zero());
  body.swings_rad_.push_back(0);
  for (const double side : {1.0, -1.0}) {
    const double arm_length = 0.42 * height, leg_radius = random.uniform(0.07, 0.09);
    Mesh arm, leg;
    add_cylinder(arm, {0, 0, -arm_length}, 0.035, 0.05, arm_length, 9);
    add_ellipsoid(arm, {0, 0, -arm_length}, {0.05, 0.04, 0.09}, 5);
    add_cylinder(leg, {0, 0, -hip + 0.05}, 0.055, leg_radius, hip, 9, Material::dark);
    add_box(leg, Vector3d(0.05, 0, -hip + 0.04), {0.26, 0.1, 0.08});  // shoe
    body.parts_.push_back(std::move(arm));
    body.joints_.emplace_back(0, side * (broad + 0.03), shoulder - 0.03);
    body.swings_rad_.push_back(side * 0.45);
    body.parts_.push_back(std::move(leg));
    body.joints_.emplace_back(0, side * 0.1, hip);
    body.swings_rad_.push_back(side * -0.42);
  }
  return body;
}

Body Body::robot() {
  Body body;
  Mesh hull;
  add_cylinder(hull, {0, 0, 0.03}, 0.22, 0.22, 0.3, 20, Material::dark);
  add_cylinder(hull, {0, 0, 0.33}, 0.05, 0.05, 0.4, 10);
  add_box(hull, Vector3d(0, 0, 0.74), {0.12, 0.2, 0.03});
  body.parts_.push_back(std::move(hull));
  body.joints_.emplace_back(Vector3d::Zero());
  body.swings_rad_.push_back(0);
  return body;
}

Pose Body::T_map_part(std::size_t part, const Pose& T_map_body, double stride_rad, double swing) const {
  Pose T_body_part = upright(joints_[part], 0);
  const double rest_rad = rests_rad_.empty() ? 0 : rests_rad_[part];
  T_body_part.rotate(
      Eigen::AngleAxisd(rest_rad + swings_rad_[part] * swing * std::sin(stride_rad), Vector3d::UnitY()));
  return T_map_body * T_body_part;
}

}  // namespace liloc::sim
