#include "common/geometry/pose_estimate.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace liloc {
namespace {

double largest_sd(const Eigen::Matrix3d& covariance) {
  return std::sqrt(std::max(covariance.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff(), 0.0));
}

}  // namespace

double PoseEstimate::sd_rad() const {
  return largest_sd(covariance.topLeftCorner<3, 3>());
}
double PoseEstimate::sd_m() const {
  return largest_sd(covariance.bottomRightCorner<3, 3>());
}

Vector6d offset_of(const Pose& T_map_sensor, const Pose& other) {
  const Eigen::Matrix3d R = T_map_sensor.linear().transpose();
  Vector6d offset;
  offset << so3_log(R * other.linear()), R * (other.translation() - T_map_sensor.translation());
  return offset;
}

PoseEstimate carried(const PoseEstimate& before, const Pose& T_before_after, double sd_rad, double sd_m) {
  const Eigen::Matrix3d R = T_before_after.linear().transpose();
  Matrix6d A = Matrix6d::Zero();  // an error of rotation before grows with the way that was gone
  A.topLeftCorner<3, 3>() = A.bottomRightCorner<3, 3>() = R;
  A.bottomLeftCorner<3, 3>() = -R * skew(T_before_after.translation());
  PoseEstimate after{before.T_map_sensor * T_before_after, A * before.covariance * A.transpose()};
  after.covariance.diagonal().head<3>().array() += sd_rad * sd_rad;
  after.covariance.diagonal().tail<3>().array() += sd_m * sd_m;
  return after;
}

double squared_mahalanobis(const Vector6d& offset, const Matrix6d& covariance) {
  return offset.dot(covariance.ldlt().solve(offset));
}

double squared_mahalanobis(const PoseEstimate& predicted, const PoseEstimate& seen) {
  return squared_mahalanobis(offset_of(predicted.T_map_sensor, seen.T_map_sensor),
                             predicted.covariance + seen.covariance);
}

}  // namespace liloc
