#include "server/localization/pose_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

namespace liloc {
namespace {

/// Draws errors, in the sensor's axes, as a covariance promises them.
class Noise {
 public:
  explicit Noise(unsigned seed) : rng_(seed) {}

  Pose disturbed(const Pose& T, const Matrix6d& covariance) {
    Vector6d unit;
    for (int i = 0; i < 6; ++i) unit[i] = normal_(rng_);
    const Vector6d error = covariance.llt().matrixL() * unit;
    Pose result = T;
    result.linear() = T.linear() * so3_exp(error.head<3>());
    result.translation() += T.linear() * error.tail<3>();
    return result;
  }

 private:
  std::mt19937 rng_;
  std::normal_distribution<double> normal_{0, 1};
};

double nees(const PoseEstimate& estimate, const Pose& truth) {
  const Eigen::Matrix3d R = truth.linear().transpose();
  Vector6d error;
  error << so3_log(R * estimate.T_map_sensor.linear()),
      R * (estimate.T_map_sensor.translation() - truth.translation());
  return error.dot(estimate.covariance.ldlt().solve(error));
}

Matrix6d diagonal(double sd_rad, double sd_m) {
  Vector6d sd;
  sd << Eigen::Vector3d::Constant(sd_rad), Eigen::Vector3d::Constant(sd_m);
  return sd.cwiseAbs2().asDiagonal();
}

class PoseFilterLaw : public testing::TestWithParam<unsigned> {};

TEST_P(PoseFilterLaw, ItsCovarianceIsThatOfItsErrors) {
  Noise noise(GetParam());
  const Pose T_step = Pose(Eigen::Translation3d(0.5, -0.2, 0.1) *
                           Eigen::AngleAxisd(0.4, Eigen::Vector3d(1, 2, 3).normalized()));
  const Matrix6d start = diagonal(0.01, 0.05), motion = diagonal(0.004, 0.01);
  Matrix6d spot = diagonal(0.003, 0.02);
  spot(3, 3) = 4;  // a corridor: nothing is seen along x
  double sum = 0;
  constexpr int kWalks = 200;
  for (int walk = 0; walk < kWalks; ++walk) {
    Pose truth = Pose(Eigen::Translation3d(3, 2, 1) * Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ()));
    PoseEstimate estimate{noise.disturbed(truth, start), start};
    for (int k = 0; k < 6; ++k) {
      truth = truth * T_step;
      estimate = carried(estimate, noise.disturbed(T_step, motion), 0.004, 0.01);
      estimate = fused(estimate, {noise.disturbed(truth, spot), spot});
    }
    sum += nees(estimate, truth);
  }
  EXPECT_NEAR(sum / kWalks, 6, 1.0);  // 6 +- 4 sd of the mean of 200
}

TEST_P(PoseFilterLaw, SquaredMahalanobisIsSixOnAverageWhereBothAreHonest) {
  Noise noise(GetParam());
  const Matrix6d before = diagonal(0.004, 0.01), spot = diagonal(0.003, 0.02);
  const Pose truth = Pose(Eigen::Translation3d(3, 2, 1) * Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ()));
  double sum = 0;
  constexpr int kSpots = 400;
  for (int i = 0; i < kSpots; ++i)
    sum += squared_mahalanobis(PoseEstimate{noise.disturbed(truth, before), before},
                               PoseEstimate{noise.disturbed(truth, spot), spot});
  EXPECT_NEAR(sum / kSpots, 6, 0.7);  // 6 +- 4 sd of the mean of 400
}

INSTANTIATE_TEST_SUITE_P(Seeds, PoseFilterLaw, testing::Range(1U, 6U));

TEST(PoseFilter, APredictionThatIsTooSureOfItselfGivesWay) {
  PoseEstimate predicted{Pose::Identity(), diagonal(0.002, 0.005)};
  PoseEstimate seen = predicted;
  seen.T_map_sensor.translation().x() = 0.2;  // odometry slipped
  const PoseEstimate estimate = fused(predicted, seen);
  EXPECT_NEAR(estimate.T_map_sensor.translation().x(), 0.2, 0.02);
  EXPECT_LT(estimate.sd_m(), 0.01);
}

TEST(PoseFilter, WhatNothingShowsStaysAsPredicted) {
  const PoseEstimate predicted{Pose::Identity(), diagonal(0.002, 0.01)};
  PoseEstimate seen{Pose::Identity(), diagonal(0.001, 0.005)};
  seen.covariance(3, 3) = 1;
  seen.T_map_sensor.translation() = Eigen::Vector3d(0.3, 0.004, 0);
  const PoseEstimate estimate = fused(predicted, seen);
  EXPECT_NEAR(estimate.T_map_sensor.translation().x(), 0, 0.001);
  EXPECT_NEAR(estimate.T_map_sensor.translation().y(), 0.004, 0.001);
  EXPECT_NEAR(estimate.sd_m(), 0.01, 0.001);
}

}  // namespace
}  // namespace liloc
