// Odometry as ROS 2 has it: understood, or refused by the name of its field.
#include <gtest/gtest.h>

#include <cmath>

#include "common/wire/dds/tests/sample_pose.hpp"
#include "common/wire/sensors/convert_sensors.hpp"

namespace liloc::wire {
namespace {

nav_msgs_msg_dds__Odometry_ odometry_message() {
  nav_msgs_msg_dds__Odometry_ m{};
  m.header = header_of(5'000'000'001, "odom");
  const Pose T = sample_pose(1);
  const Eigen::Quaterniond q(T.linear());
  m.pose.pose.position = {T.translation().x(), T.translation().y(), T.translation().z()};
  m.pose.pose.orientation = {q.x(), q.y(), q.z(), q.w()};
  for (int i = 0; i < 6; ++i) m.pose.covariance[7 * i] = i + 1;
  return m;
}

TEST(ConvertOdometry, IsUnderstoodAndHostileFieldsAreNamed) {
  const auto odometry = from_wire(odometry_message());
  ASSERT_TRUE(odometry) << odometry.error().message;
  EXPECT_EQ(odometry->stamp_ns, 5'000'000'001);
  EXPECT_EQ(odometry->frame_id, "odom");
  EXPECT_LT(distance_m(odometry->T_odom_base, sample_pose(1)), 1e-12);
  EXPECT_DOUBLE_EQ(odometry->covariance(0, 0), 4);  // rotation comes first here
  EXPECT_DOUBLE_EQ(odometry->covariance(5, 5), 3);

  const std::pair<const char*, void (*)(nav_msgs_msg_dds__Odometry_&)> cases[] = {
      {"header.stamp", [](auto& m) { m.header.stamp.sec = -1; }},
      {"pose.pose", [](auto& m) { m.pose.pose.position.x = NAN; }},
      {"pose.pose", [](auto& m) { m.pose.pose.orientation.w = 2; }}};
  for (const auto& [field, spoil] : cases) {
    auto m = odometry_message();
    spoil(m);
    const auto refused = from_wire(m);
    ASSERT_FALSE(refused) << field;
    EXPECT_NE(refused.error().message.find(field), std::string::npos) << refused.error().message;
  }
}

TEST(ConvertOdometry, ACovarianceThatIsUnknownIsNoReasonToDropThePose) {
  for (const double unknown : {-1.0, static_cast<double>(NAN)}) {
    auto m = odometry_message();
    std::fill(std::begin(m.pose.covariance), std::end(m.pose.covariance), unknown);
    const auto odometry = from_wire(m);
    ASSERT_TRUE(odometry) << odometry.error().message;
    EXPECT_LT(distance_m(odometry->T_odom_base, sample_pose(1)), 1e-12);
    EXPECT_FALSE(odometry->covariance(0, 0) >= 0);
  }
}

}  // namespace
}  // namespace liloc::wire
