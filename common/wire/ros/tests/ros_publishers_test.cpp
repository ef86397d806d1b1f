#include "common/wire/ros/ros_publishers.hpp"

#include <gtest/gtest.h>

#include <mutex>
#include <thread>

#include "common/wire/dds/tests/sample_pose.hpp"
#include "common/wire/sensors/sensors.hpp"

namespace liloc::wire {
namespace {

using namespace std::chrono_literals;
constexpr int kDomain = 119;  // of this test alone

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

}  // namespace
}  // namespace liloc::wire
