#include "common/geometry/pose.hpp"

#include <gmock/gmock.h>

#include <random>

namespace liloc {
namespace {

Pose random_pose(unsigned seed, double angle_rad = 3.0, double shift_m = 5.0) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  Vector6d a;
  for (int i = 0; i < 6; ++i) a[i] = unit(rng) * (i < 3 ? angle_rad / std::sqrt(3.0) : shift_m);
  return increment(a);
}

class PoseLaw : public testing::TestWithParam<unsigned> {};

TEST_P(PoseLaw, LogUndoesExp) {
  const Pose T = random_pose(GetParam());
  EXPECT_TRUE(so3_exp(so3_log(T.linear())).isApprox(T.linear(), 1e-9));
}

TEST_P(PoseLaw, ExpNearZeroIsLinear) {
  const Eigen::Vector3d w = 1e-8 * random_pose(GetParam()).translation();
  EXPECT_TRUE(so3_exp(w).isApprox(Eigen::Matrix3d::Identity() + skew(w), 1e-12));
}

TEST_P(PoseLaw, TheDerivativeOfARotatedPointIsMinusItsSkew) {
  const Pose T = random_pose(GetParam());
  const Eigen::Vector3d p = T * Eigen::Vector3d(0.3, -1.2, 2.0);
  for (int axis = 0; axis < 6; ++axis) {
    Vector6d step = Vector6d::Zero();
    step[axis] = 1e-6;
    const Eigen::Vector3d numeric = (increment(step) * p - increment(-step) * p) / 2e-6;
    const Eigen::Vector3d analytic =
        axis < 3 ? Eigen::Vector3d(-skew(p).col(axis)) : Eigen::Vector3d::Unit(axis - 3);
    EXPECT_LT((numeric - analytic).norm(), 1e-7) << "axis " << axis;
  }
}

TEST_P(PoseLaw, InterpolationMeetsBothEndsAndSplitsTheAngle) {
  const Pose a = random_pose(GetParam()), b = a * random_pose(GetParam() + 1000, 2.5);
  EXPECT_TRUE(interpolate(a, b, 0).isApprox(a, 1e-9));
  EXPECT_TRUE(interpolate(a, b, 1).isApprox(b, 1e-9));
  EXPECT_NEAR(angle_between_rad(a, interpolate(a, b, 0.25)), 0.25 * angle_between_rad(a, b), 1e-9);
}

TEST_P(PoseLaw, DistanceAndAngleAreSymmetric) {
  const Pose a = random_pose(GetParam()), b = random_pose(GetParam() + 500);
  EXPECT_NEAR(angle_between_rad(a, b), angle_between_rad(b, a), 1e-12);
  EXPECT_NEAR(distance_m(a, b), (a.inverse() * b).translation().norm(), 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Seeds, PoseLaw, testing::Range(1U, 33U));

TEST(ValidPose, NamesWhatIsWrong) {
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  EXPECT_TRUE(valid_pose(origin, {0, 0, 0, 1}, "T"));
  EXPECT_THAT(valid_pose(origin, {0, 0, 0, 2}, "lidar.T_map_sensor").error().message,
              testing::HasSubstr("lidar.T_map_sensor.rotation_xyzw"));
  EXPECT_FALSE(valid_pose(origin, {0, 0, 0, NAN}, "T"));
  EXPECT_THAT(valid_pose({NAN, 0, 0}, {0, 0, 0, 1}, "T").error().message, testing::HasSubstr("T.translation"));
}

}  // namespace
}  // namespace liloc
