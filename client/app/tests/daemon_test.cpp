// The daemon between a robot's topics and a server, all in one process over DDS.
#include "client/app/daemon.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "client/api/tests/by_heart_server.hpp"
#include "common/geometry/depth.hpp"
#include "common/testing/box_room.hpp"
#include "common/wire/sensors/sensor_publishers.hpp"

namespace liloc {
namespace {

using namespace std::chrono_literals;
using ::testing::HasSubstr;

constexpr int kDomain = 144;  // of this test alone
constexpr StampNs kStart = 1'700'000'000'000'000'000;

/// Turns slowly in the middle of the room.
Pose drive(double t) {
  return scene::looking({3 + 0.1 * t, 2.5, 1.2}, 0.2 * t, 0.2);
}

DaemonOptions options(std::vector<const char*> extra) {
  std::vector<const char*> arguments{"liloc-client", "--id",          "robot1", "--domain",
                                     "144",          "--interval-ms", "200",    "--ros"};
  arguments.insert(arguments.end(), extra.begin(), extra.end());
  int exit_code = 0;
  auto parsed = parse_arguments(static_cast<int>(arguments.size()), arguments.data(), exit_code);
  EXPECT_TRUE(parsed) << parsed.error().message;
  return *parsed;
}

TEST(Daemon, LocatesARobotByItsWheelsAndClouds) {
  const auto server = test::ByHeartServer::start(kDomain);
  ASSERT_TRUE(server) << server.error().message;
  auto daemon = Daemon::start(options({"--points-topic", "cloud", "--points-view", "160", "120", "70", "55",
                                       "--odometry-topic", "/wheels/odom", "--odom-frame", "wheels/odom"}),
                              [] { return false; });
  ASSERT_TRUE(daemon) << daemon.error().message;
  const auto seat = *wire::Participant::create({.domain = kDomain, .role = wire::Role::source});
  const auto wheels = *wire::RosPublisher::create(seat, "wheels", wire::RosNames::of("wheels"));
  auto clouds = wire::PointsPublisher::create_at(seat, "rt/cloud", "sensor");
  ASSERT_TRUE(clouds) << clouds.error().message;
  const auto room = scene::furnished_room(1);
  for (int i = 0; i < 200 && (*daemon)->summary().find("tracking") == std::string::npos; ++i) {
    const double t = 0.05 * i;
    const StampNs stamp = kStart + from_seconds(t);
    ASSERT_TRUE(wheels.publish_odometry(stamp, drive(t)));
    const auto cloud =
        depth_to_cloud(scene::render(room, drive(t), scene::small_camera(), stamp), scene::small_camera());
    ASSERT_TRUE(clouds->publish(stamp, *cloud));
    std::this_thread::sleep_for(30ms);
  }
  EXPECT_THAT((*daemon)->summary(), HasSubstr("robot1: tracking, server there"));
  EXPECT_TRUE((*daemon)->check_address()) << "the loopback does not roam";
  EXPECT_THAT((*daemon)->summary(), HasSubstr("ms per localized second"));
  EXPECT_TRUE((*daemon)->stop());
}

TEST(Daemon, CountsAndTellsFramesOfAnotherSize) {
  auto chosen = options({});
  const Camera camera = scene::small_camera();
  chosen.client.camera = {camera.width, camera.height, camera.fx,           camera.fy,
                          camera.cx,    camera.cy,     camera.depth_scale_m};
  auto daemon = Daemon::start(chosen, [] { return false; });
  ASSERT_TRUE(daemon) << daemon.error().message;
  const auto seat = *wire::Participant::create({.domain = kDomain, .role = wire::Role::source});
  const auto depth = *wire::DepthPublisher::create(seat, "robot1", shrunk(camera, 2));
  const auto told = [&] { return (*daemon)->summary().find("depth image is 80x60") != std::string::npos; };
  for (int i = 0; i < 200 && !told(); ++i) {
    EXPECT_TRUE(depth.publish(
        scene::render(scene::furnished_room(1), drive(0), shrunk(camera, 2), kStart + from_ms(50.0 * i))));
    std::this_thread::sleep_for(30ms);
  }
  EXPECT_TRUE(told()) << (*daemon)->summary();
  EXPECT_THAT((*daemon)->summary(), testing::Not(HasSubstr(" 0 refused, ")));
  EXPECT_TRUE((*daemon)->stop());
}

TEST(SensorFeed, WhatIsLeftOutIsToldInOneLine) {
  auto chosen = options({});
  chosen.client.camera = {160, 120, 115, 115, 79.5, 59.5, 0.001};
  auto robot = client::Client::create(chosen.client, {}, {});
  ASSERT_TRUE(robot) << robot.error();
  SensorFeed feed(chosen, *robot.value());
  std::vector<std::string> lines;
  log::set_sink([&](log::Level, std::string_view line) { lines.emplace_back(line); });
  for (int i = 0; i < 3; ++i) {
    feed.take_imu(fail("the force is not finite"));
    feed.take_camera_info(fail("k is not [fx 0 cx; 0 fy cy; 0 0 1]"));
  }
  log::set_sink({});
  EXPECT_THAT(lines, testing::ElementsAre("the force is not finite",
                                          "camera_info is left out: k is not [fx 0 cx; 0 fy cy; 0 0 1]; the "
                                          "intrinsics in use stay"));
}

TEST(Daemon, TellsRosTheOdometryOfADepthCamera) {
  const auto server = test::ByHeartServer::start(kDomain);
  ASSERT_TRUE(server) << server.error().message;
  const auto seat = *wire::Participant::create({.domain = kDomain, .role = wire::Role::source});
  const Camera camera = scene::small_camera();
  const auto depth = *wire::DepthPublisher::create(seat, "robot1", camera);
  auto listening = *wire::Dispatcher::create(seat);
  std::atomic<int> heard = 0;
  std::atomic<double> moved_m = 0;
  ASSERT_TRUE(wire::subscribe_odometry_at(*listening, "rt/robot1/odom",
                                          [&](const Result<wire::StampedOdometry>& odometry) {
                                            ASSERT_TRUE(odometry) << odometry.error().message;
                                            EXPECT_EQ(odometry->frame_id, "robot1/odom");
                                            moved_m = odometry->T_odom_base.translation().norm();
                                            ++heard;
                                          }));
  listening->start();
  const auto room = scene::furnished_room(1);
  std::atomic<bool> done = false;
  std::jthread camera_driver([&] {  // its camera_info gives the daemon the intrinsics
    for (int i = 0; !done && i < 400; ++i) {
      const double t = 0.05 * i;
      EXPECT_TRUE(depth.publish(scene::render(room, drive(t), camera, kStart + from_seconds(t))));
      std::this_thread::sleep_for(30ms);
    }
  });
  auto daemon = Daemon::start(options({}), [] { return false; });
  ASSERT_TRUE(daemon) << daemon.error().message;
  for (int i = 0; i < 500 && heard < 20; ++i) std::this_thread::sleep_for(20ms);
  done = true;
  camera_driver.join();
  EXPECT_GE(heard, 20);
  EXPECT_GT(moved_m, 0.05);
  EXPECT_TRUE((*daemon)->stop());
  listening->stop();
}

}  // namespace
}  // namespace liloc
