// What goes to ROS and comes from it: odometry and diagnostics over DDS, and the covariance's frames.
#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <thread>

#include "common/wire/convert.hpp"
#include "common/wire/convert_ros.hpp"
#include "common/wire/convert_sensors.hpp"
#include "common/wire/sensors.hpp"
#include "common/wire/typed.hpp"
#include "samples.hpp"

namespace liloc::wire {
namespace {

using namespace std::chrono_literals;
constexpr int kDomain = 119;  // of this test alone

TEST(DdsTopic, RosNamesAreTaken) {
  EXPECT_EQ(*dds_topic("/camera/depth/image_raw"), "rt/camera/depth/image_raw");
  EXPECT_EQ(*dds_topic("odom"), "rt/odom");
  for (const char* bad : {"", "/", "a b", "a//b", "a/", "a\"b", "a-b"}) EXPECT_FALSE(dds_topic(bad)) << bad;
}

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

nav_msgs_msg_dds__Odometry_ odometry_message() {
  nav_msgs_msg_dds__Odometry_ m{};
  m.header = header_of(5'000'000'001, "odom");
  m.pose.pose = ros_pose(sample_pose(1));
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

TEST(RosPublisher, ItsOdometryIsHeard) {
  const auto seat = Participant::create({.domain = kDomain}).value();
  auto dispatcher = Dispatcher::create(seat).value();
  std::mutex mutex;
  std::optional<StampedOdometry> heard;
  ASSERT_TRUE(
      subscribe_odometry_at(*dispatcher, "rt/robot1/odom", [&](const Result<StampedOdometry>& odometry) {
        const std::scoped_lock lock(mutex);
        if (odometry) heard = *odometry;
      }));
  dispatcher->start();
  const auto publisher = RosPublisher::create(seat, "robot1", RosNames::of("robot1")).value();
  for (int i = 0; i < 500; ++i, std::this_thread::sleep_for(10ms)) {
    ASSERT_TRUE(publisher.publish_odometry(1'000'000'000, sample_pose(2)));
    ASSERT_TRUE(publisher.publish_map_odom(1'000'000'000, sample_pose(2)));
    const std::scoped_lock lock(mutex);
    if (heard) break;
  }
  dispatcher->stop();
  ASSERT_TRUE(heard);
  EXPECT_EQ(heard->frame_id, "robot1/odom");
  EXPECT_LT(distance_m(heard->T_odom_base, sample_pose(2)), 1e-12);
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
