#include "common/geometry/pose_estimate.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <random>

namespace liloc {
namespace {

Vector6d drawn(std::mt19937& rng, const Matrix6d& covariance) {
  std::normal_distribution<double> normal(0, 1);
  Vector6d unit;
  for (int i = 0; i < 6; ++i) unit[i] = normal(rng);
  return covariance.llt().matrixL() * unit;
}

Pose disturbed(const Pose& T, const Vector6d& error) {
  Pose result = T;
  result.linear() = T.linear() * so3_exp(error.head<3>());
  result.translation() += T.linear() * error.tail<3>();
  return result;
}

Matrix6d diagonal(double sd_rad, double sd_m) {
  Vector6d sd;
  sd << Eigen::Vector3d::Constant(sd_rad), Eigen::Vector3d::Constant(sd_m);
  return sd.cwiseAbs2().asDiagonal();
}

class PoseEstimateLaw : public testing::TestWithParam<unsigned> {};

TEST_P(PoseEstimateLaw, TheOffsetIsWhatDisturbed) {
  std::mt19937 rng(GetParam());
  const Pose T = increment(drawn(rng, diagonal(1, 3)));
  const Vector6d error = drawn(rng, diagonal(0.2, 0.5));
  EXPECT_LT((offset_of(T, disturbed(T, error)) - error).norm(), 1e-9);
}

TEST_P(PoseEstimateLaw, ACarriedCovarianceIsThatOfTheErrors) {
  std::mt19937 rng(GetParam());
  const Pose truth = increment(drawn(rng, diagonal(1, 3))), T_step = increment(drawn(rng, diagonal(0.3, 1)));
  const Matrix6d before = diagonal(0.01, 0.05);
  constexpr double kSdRad = 0.004, kSdM = 0.02;
  double sum = 0;
  constexpr int kDraws = 500;
  for (int i = 0; i < kDraws; ++i) {
    const PoseEstimate estimate = carried({disturbed(truth, drawn(rng, before)), before}, T_step, kSdRad, kSdM);
    const Pose seen = disturbed(truth * T_step, drawn(rng, diagonal(kSdRad, kSdM)));
    const Vector6d error = offset_of(estimate.T_map_sensor, seen);
    sum += squared_mahalanobis(error, estimate.covariance);
  }
  EXPECT_NEAR(sum / kDraws, 6, 0.7);  // its deviation is 0.15
}

TEST_P(PoseEstimateLaw, TheDistanceIsSixOnAverage) {
  std::mt19937 rng(GetParam());
  const Pose truth = increment(drawn(rng, diagonal(1, 3)));
  const Matrix6d a = diagonal(0.01, 0.05), b = diagonal(0.02, 0.01);
  double sum = 0;
  constexpr int kDraws = 500;
  for (int i = 0; i < kDraws; ++i)
    sum += squared_mahalanobis(PoseEstimate{disturbed(truth, drawn(rng, a)), a},
                               PoseEstimate{disturbed(truth, drawn(rng, b)), b});
  EXPECT_NEAR(sum / kDraws, 6, 0.7);
}
INSTANTIATE_TEST_SUITE_P(Seeds, PoseEstimateLaw, testing::Range(1U, 9U));

}  // namespace
}  // namespace liloc
