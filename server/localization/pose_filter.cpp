#include "server/localization/pose_filter.hpp"

#include <Eigen/Dense>

namespace liloc {
PoseEstimate fused(PoseEstimate predicted, const PoseEstimate& seen, double chi_square_limit) {
  for (int i = 0; i < 20 && squared_mahalanobis(predicted, seen) > chi_square_limit; ++i)
    predicted.covariance *= 2;
  const Vector6d innovation = offset_of(predicted.T_map_sensor, seen.T_map_sensor);
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
