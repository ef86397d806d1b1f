#include "common/geometry/pose.hpp"

#include <algorithm>
#include <cmath>

namespace liloc {

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Eigen::Matrix3d so3_exp(const Eigen::Vector3d& rotation_rad) {
  const double angle = rotation_rad.norm();
  if (angle < 1e-12) return Eigen::Matrix3d::Identity() + skew(rotation_rad);
  return Eigen::AngleAxisd(angle, rotation_rad / angle).toRotationMatrix();
}

Eigen::Vector3d so3_log(const Eigen::Matrix3d& rotation) {
  Eigen::Quaterniond q(rotation);
  q.normalize();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  if (sine < 1e-12) return 2.0 * q.vec();
  return q.vec() * (2.0 * std::atan2(sine, q.w()) / sine);
}

Pose increment(const Vector6d& a) {
  Pose T = Pose::Identity();
  T.linear() = so3_exp(a.head<3>());
  T.translation() = a.tail<3>();
  return T;
}

Pose interpolate(const Pose& a, const Pose& b, double share) {
  Pose T = Pose::Identity();
  T.linear() = a.linear() * so3_exp(share * so3_log(a.linear().transpose() * b.linear()));
  T.translation() = (1.0 - share) * a.translation() + share * b.translation();
  return T;
}

double rotation_angle_rad(const Pose& T) {
  return so3_log(T.linear()).norm();
}

double angle_between_rad(const Pose& a, const Pose& b) {
  return so3_log(a.linear().transpose() * b.linear()).norm();
}

double distance_m(const Pose& a, const Pose& b) {
  return (a.translation() - b.translation()).norm();
}

Pose normalized(const Pose& T) {
  Pose result = T;
  result.linear() = Eigen::Quaterniond(T.linear()).normalized().toRotationMatrix();
  return result;
}

Result<Pose> valid_pose(const Eigen::Vector3d& translation_m, const Eigen::Vector4d& rotation_xyzw,
                        std::string_view what) {
  if (!translation_m.allFinite() || translation_m.cwiseAbs().maxCoeff() > 1e5)
    return fail("{}.translation is [{} {} {}]; give three finite metres within 1e5", what, translation_m.x(),
                translation_m.y(), translation_m.z());
  const double norm = rotation_xyzw.norm();
  if (!rotation_xyzw.allFinite() || std::abs(norm - 1.0) > 1e-2)
    return fail("{}.rotation_xyzw has length {:.4g}, not 1; give a unit quaternion [x y z w]", what, norm);
  Pose T = Pose::Identity();
  T.linear() = Eigen::Quaterniond(rotation_xyzw).normalized().toRotationMatrix();
  T.translation() = translation_m;
  return T;
}

}  // namespace liloc
