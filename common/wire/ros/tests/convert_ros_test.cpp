#include "common/wire/ros/convert_ros.hpp"

#include <gtest/gtest.h>

#include "common/wire/dds/convert.hpp"
#include "common/wire/dds/tests/sample_pose.hpp"

namespace liloc::wire {
namespace {

TEST(RosPose, CovarianceIsTurnedIntoTheMapsAxesAndRossOrder) {
  Matrix6d covariance = Matrix6d::Zero();
  covariance.diagonal() << 1, 2, 3, 4, 5, 6;  // rotation, then translation, sensor axes
  Pose T = Pose::Identity();
  T.linear() = Eigen::AngleAxisd(radians(90), Eigen::Vector3d::UnitZ()).toRotationMatrix();  // x -> y
  const auto m = pose_message(1, "map", T, covariance);
  const double expected[] = {5, 4, 6, 2, 1, 3};
  for (int i = 0; i < 6; ++i) EXPECT_NEAR(m.pose.covariance[7 * i], expected[i], 1e-12) << i;
}

/// The message's covariance must be that of the pose's errors in the map, drawn here.
TEST(RosPose, CovarianceIsThatOfDrawnErrors) {
  const Pose T = sample_pose(1) * Pose(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()));
  Matrix6d covariance = 1e-6 * Matrix6d::Identity();
  covariance(1, 1) = 9e-6;
  covariance(5, 5) = 4e-6;
  covariance(1, 5) = covariance(5, 1) = 3e-6;
  const Matrix6d root = covariance.llt().matrixL();
  std::srand(7);
  Matrix6d drawn = Matrix6d::Zero();
  constexpr int kDraws = 40'000;
  for (int i = 0; i < kDraws; ++i) {
    Vector6d normal = Vector6d::Zero();
    for (int k = 0; k < 12; ++k) normal += 0.5 * Vector6d::Random();  // nearly normal, variance 1
    const Vector6d e = root * normal;
    const Eigen::Matrix3d R = T.linear() * so3_exp(e.head<3>());
    Vector6d ros;
    ros << T.linear() * e.tail<3>(), so3_log(R * T.linear().transpose());  // turned about the map's axes
    drawn += ros * ros.transpose() / kDraws;
  }
  const auto m = pose_message(1, "map", T, covariance);
  const Matrix6d told = Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>>(m.pose.covariance);
  EXPECT_LT((told - drawn).cwiseAbs().maxCoeff(), 3e-7);
}

TEST(Diagnostics, LongTextsAreCutAndFieldsBounded) {
  Diagnosis diagnosis{Diagnosis::Level::warn, std::string(500, 'n'), std::string(5000, 'm'), {}};
  for (int i = 0; i < 100; ++i) diagnosis.values.emplace_back("key", "value");
  const auto sample = diagnostics_message(1, "robot1", diagnosis);
  const auto& status = sample->message.status._buffer[0];
  EXPECT_EQ(text_of(status.name).size(), 255U);
  EXPECT_EQ(text_of(status.message).size(), 1023U);
  EXPECT_EQ(status.values._length, 64U);
  EXPECT_EQ(text_of(status.hardware_id), "robot1");
}

}  // namespace
}  // namespace liloc::wire
