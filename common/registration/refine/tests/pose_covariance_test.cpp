#include "common/registration/refine/pose_covariance.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <vector>

#include "common/registration/refine/refine.hpp"
#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

Vector6d error_of(const Pose& T, const Pose& truth) {
  const Eigen::Matrix3d R = truth.linear().transpose();
  Vector6d error;
  error << so3_log(R * T.linear()), R * (T.translation() - truth.translation());
  return error;
}

TEST(PoseCovariance, CoversTheErrorsOfRefinementInFurnishedRooms) {
  double sum = 0;
  int beyond = 0;
  constexpr unsigned kRooms = 40;
  for (unsigned seed = 1; seed <= kRooms; ++seed) {
    const WatchedRoom w = watched_room(seed);
    const Pose T = refine(w.target, w.query, w.T_map_device).T_target_source;
    const Vector6d error = error_of(T, w.T_map_device);
    const double nees = error.dot(pose_covariance(w.target, w.query, T).ldlt().solve(error));
    sum += std::min(nees, 100.0);
    beyond += nees > 14.449;  // 97.5 % of chi-squared with six degrees of freedom
  }
  EXPECT_GT(sum / kRooms, 2.0) << "too wide";
  EXPECT_LT(sum / kRooms, 10.0) << "too narrow";
  EXPECT_LE(beyond, 5);
}

TEST(PoseCovariance, AWallSaysNothingOfWhereAlongItTheDeviceStands) {
  const scene::BoxRoom bare = scene::corridor();
  const Pose T_map_device = scene::looking({3.0, 1.0, 1.2}, radians(90), 0);
  const Matrix6d covariance = pose_covariance(watch(bare, 1), look(bare, T_map_device, 2), T_map_device);
  const Eigen::Matrix3d R = T_map_device.linear();
  const Eigen::Matrix3d in_map = R * covariance.bottomRightCorner<3, 3>() * R.transpose();
  EXPECT_GT(std::sqrt(in_map(0, 0)), 0.05);
  EXPECT_LT(std::sqrt(in_map(1, 1)), 0.02);
}

TEST(PoseCovariance, TurnsWithTheSensorsAxes) {
  const WatchedRoom w = watched_room(3);
  const Pose T_sensor_turned = Pose(Eigen::AngleAxisd(radians(90), Eigen::Vector3d::UnitZ()));
  Query turned = w.query;
  turned.view = {};
  for (Cloud* cloud : {&turned.cloud, &turned.medium, &turned.sparse})
    *cloud = transformed(T_sensor_turned.inverse(), *cloud);
  Query plain = w.query;
  plain.view = {};
  const Matrix6d before = pose_covariance(w.target, plain, w.T_map_device);
  const Matrix6d after = pose_covariance(w.target, turned, w.T_map_device * T_sensor_turned);
  Matrix6d R = Matrix6d::Zero();
  R.topLeftCorner<3, 3>() = R.bottomRightCorner<3, 3>() = T_sensor_turned.linear();
  EXPECT_TRUE((R * after * R.transpose()).isApprox(before, 0.05)) << before << "\n\n"
                                                                  << R * after * R.transpose();
}

TEST(PoseCovariance, SurroundingsPlacedByOdometryAreTrustedLess) {
  const WatchedRoom w = watched_room(5);
  const Camera camera = scene::small_camera();
  Query narrow = w.query;  // the same points, of which the frame saw only the middle
  Camera middle = camera;
  middle.width /= 2;
  middle.cx -= camera.width / 4.0;
  narrow.view = SightView::from_cloud(w.query.cloud, middle, 0.05, middle.width / 2);
  const Matrix6d seen = pose_covariance(w.target, w.query, w.T_map_device);
  const Matrix6d remembered = pose_covariance(w.target, narrow, w.T_map_device);
  EXPECT_GT(remembered.trace(), seen.trace());
}

TEST(PoseCovariance, OfNothingIsTheMost) {
  const WatchedRoom w = watched_room(1);
  Pose far = w.T_map_device;
  far.translation().x() += 100;
  EXPECT_TRUE(pose_covariance(w.target, w.query, far).isApprox(Matrix6d::Identity()));
  EXPECT_TRUE(pose_covariance(w.target, Query{}, w.T_map_device).isApprox(Matrix6d::Identity()));
}

}  // namespace
}  // namespace liloc
