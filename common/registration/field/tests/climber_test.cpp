#include "common/registration/field/climber.hpp"

#include <gtest/gtest.h>

#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

class ClimberLaw : public testing::TestWithParam<unsigned> {};

TEST_P(ClimberLaw, ClimbingEndsNearTheDeviceAndNeverLower) {
  const WatchedRoom w = watched_room(GetParam());
  const Eigen::Matrix3d R =
      Eigen::Quaterniond::FromTwoVectors(w.up_device, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  Pose level = Pose::Identity();
  level.linear() = R;
  const Cloud points = transformed(level, w.query.sparse);
  Climber climber(w.target->field_fine().regions().front(), nullptr, Eigen::Vector3d::UnitZ(), points);
  const Eigen::Matrix3d turn = w.T_map_device.linear() * R.transpose();
  const double yaw = std::atan2(turn(1, 0), turn(0, 0));
  Eigen::Vector4d start;
  start << w.T_map_device.translation() + Eigen::Vector3d(0.08, -0.08, 0.06), yaw + radians(2);
  const LevelPose top = climber.climb(start, {});
  EXPECT_LT((top.pose.head<3>() - w.T_map_device.translation()).norm(), 0.25);  // the fine field resolves 0.1 m
  EXPECT_LT(std::abs(std::remainder(top.pose[3] - yaw, 2 * M_PI)), radians(3));
  EXPECT_GE(top.score, climber.climb(start, {0.1, 0.04, 0, 0, 240}).score);
}

INSTANTIATE_TEST_SUITE_P(Seeds, ClimberLaw, testing::Range(1U, 6U));

}  // namespace
}  // namespace liloc
