#include "server/localization/pose_filter.hpp"

#include <Eigen/Dense>
#include <cmath>

namespace liloc {
namespace {

double largest_sd(const Eigen::Matrix3d& covariance) {
  return std::sqrt(std::max(covariance.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff(), 0.0));
}

Vector6d innovation_of(const PoseEstimate& predicted, const PoseEstimate& seen) {
  const Eigen::Matrix3d R = predicted.T_map_sensor.linear().transpose();
  Vector6d innovation;
  innovation << so3_log(R * seen.T_map_sensor.linear()),
      R * (seen.T_map_sensor.translation() - predicted.T_map_sensor.translation());
  return innovation;
}

}  // namespace

double PoseEstimate::sd_rad() const {
  return largest_sd(covariance.topLeftCorner<3, 3>());
}
double PoseEstimate::sd_m() const {
  return largest_sd(covariance.bottomRightCorner<3, 3>());
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

double surprise_of(const PoseEstimate& predicted, const PoseEstimate& seen) {
  const Vector6d innovation = innovation_of(predicted, seen);
  return innovation.dot((predicted.covariance + seen.covariance).ldlt().solve(innovation));
}

PoseEstimate fused(PoseEstimate predicted, const PoseEstimate& seen, double surprise_limit) {
  for (int i = 0; i < 20 && surprise_of(predicted, seen) > surprise_limit; ++i) predicted.covariance *= 2;
  const Vector6d innovation = innovation_of(predicted, seen);
  const Matrix6d gain = predicted.covariance * (predicted.covariance + seen.covariance).inverse();
  const Vector6d step = gain * innovation;
  PoseEstimate result = predicted;
  result.T_map_sensor.linear() = predicted.T_map_sensor.linear() * so3_exp(step.head<3>());
  result.T_map_sensor.translation() += predicted.T_map_sensor.linear() * step.tail<3>();
  const Matrix6d rest = Matrix6d::Identity() - gain;  // Joseph's form stays symmetric and positive
  result.covariance =
      rest * predicted.covariance * rest.transpose() + gain * seen.covariance * gain.transpose();
  return result;
}

}  // namespace liloc
