#include "common/wire/sensors/sensors.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <thread>

#include "common/wire/sensors/sensor_publishers.hpp"

namespace liloc::wire {
namespace {

using namespace std::chrono_literals;
constexpr int kDomain = 120;  // of this test alone

TEST(DdsTopic, RosNamesAreTaken) {
  EXPECT_EQ(*dds_topic("/camera/depth/image_raw"), "rt/camera/depth/image_raw");
  EXPECT_EQ(*dds_topic("odom"), "rt/odom");
  for (const char* bad : {"", "/", "a b", "a//b", "a/", "a\"b"}) EXPECT_FALSE(dds_topic(bad)) << bad;
}

TEST(Sensors, EachStreamReachesItsHandlerAndAnErrorNamesItsField) {
  const auto seat = Participant::create({.domain = kDomain}).value();
  const auto dispatcher = Dispatcher::create(seat).value();
  std::atomic<int> points = 0, samples = 0, refused = 0, elsewhere = 0;
  std::atomic<std::size_t> size = 0;
  ASSERT_TRUE(subscribe_points(*dispatcher, "robot1", [&](const Result<StampedCloud>& cloud) {
    if (cloud) size = cloud->cloud_sensor.points.size();
    ++points;
  }));
  ASSERT_TRUE(subscribe_imu(*dispatcher, "robot1", [&](const Result<ImuSample>& sample) {
    if (sample)
      ++samples;
    else if (sample.error().message.find("angular_velocity") != std::string::npos)
      ++refused;
  }));
  ASSERT_TRUE(subscribe_imu(*dispatcher, "robot2", [&](const Result<ImuSample>&) { ++elsewhere; }));
  dispatcher->start();
  const auto cloud_out = PointsPublisher::create(seat, "robot1").value();
  const auto imu_out = ImuPublisher::create(seat, "robot1").value();
  Cloud cloud;
  cloud.points = {{1, 2, 3}, {NAN, 0, 0}, {4, 5, 6}};
  for (int i = 0; i < 500 && (points == 0 || samples == 0 || refused == 0); ++i) {
    ASSERT_TRUE(cloud_out.publish(1'000'000'000, cloud));
    ASSERT_TRUE(imu_out.publish({1'000'000'000, {0, 0, 0.1}, {0, 0, 9.8}}));
    ASSERT_TRUE(imu_out.publish({1'000'000'000, {0, 0, 1e6}, {0, 0, 9.8}}));
    std::this_thread::sleep_for(10ms);
  }
  dispatcher->stop();
  EXPECT_GT(points, 0);
  EXPECT_EQ(size, 2U) << "a point that is not finite is no return";
  EXPECT_GT(samples, 0);
  EXPECT_GT(refused, 0);
  EXPECT_EQ(elsewhere, 0);
}

}  // namespace
}  // namespace liloc::wire
