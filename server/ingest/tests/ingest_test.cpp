// Ceiling streams over DDS on loopback, to frames and health.
#include "server/ingest/ingest.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

#include "common/wire/sensors/sensor_publishers.hpp"

namespace liloc {
namespace {

using namespace std::chrono_literals;
using wire::LidarState;

constexpr Camera kCamera{32, 24, 30, 30, 16, 12, 0.001};

Site two_lidars() {
  Site site;
  site.global_lidars = {{"ceiling0", kCamera, 10, Pose::Identity()},
                        {"ceiling1", kCamera, 10, Pose::Identity()}};
  return site;
}

DepthImage image(StampNs stamp_ns, int width = kCamera.width) {
  DepthImage depth{stamp_ns, width, kCamera.height, {}};
  depth.units.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(kCamera.height), 2000);
  depth.units[5] = 1234;
  return depth;
}

bool eventually(const std::function<bool()>& holds, std::chrono::milliseconds limit = 5s) {
  for (auto waited = 0ms; waited < limit; waited += 10ms, std::this_thread::sleep_for(10ms))
    if (holds()) return true;
  return false;
}

// An ingest that counts what it hands on; its domain is the test's.
struct Ceiling {
  explicit Ceiling(int domain)
      : seat(wire::Participant::create({.domain = domain, .role = wire::Role::server}).value()),
        dispatcher(wire::Dispatcher::create(seat).value()) {
    FrameSink sink;
    sink.add_depth = [this](std::size_t lidar, const DepthImage& depth) -> Status {
      if (depth.stamp_ns == 666) return fail("stamp is 666");
      ++depth_frames[lidar];
      newest_ns[lidar] = depth.stamp_ns;
      value_at_5 = depth.units[5];
      return {};
    };
    sink.add_points = [this](std::size_t lidar, StampNs, const Cloud& cloud) -> Status {
      ++point_frames[lidar];
      points = cloud.size();
      return {};
    };
    sink.on_frame = [this] { ++told; };
    ingest = Ingest::create(*dispatcher, two_lidars(), std::move(sink)).value();
    dispatcher->start();
  }
  ~Ceiling() { dispatcher->stop(); }

  wire::Participant seat;
  std::unique_ptr<wire::Dispatcher> dispatcher;
  std::array<std::atomic<int>, 2> depth_frames{}, point_frames{};
  std::atomic<int> told = 0, value_at_5 = 0;
  std::array<std::atomic<StampNs>, 2> newest_ns{};
  std::atomic<std::size_t> points = 0;
  std::unique_ptr<Ingest> ingest;
};

TEST(Ingest, ImagesArriveAsFramesOfTheirLidar) {
  Ceiling ceiling(121);
  const auto publisher = wire::DepthPublisher::create(ceiling.seat, "ceiling1", kCamera);
  ASSERT_TRUE(publisher) << publisher.error().message;
  ASSERT_TRUE(eventually([&] { return publisher->readers() == 1; }));
  EXPECT_FALSE(ceiling.ingest->seen_until()) << "nobody waits for LiDARs that were never heard";
  ASSERT_TRUE(publisher->publish(image(50)));
  ASSERT_TRUE(eventually([&] { return ceiling.told == 1; }));
  EXPECT_EQ(ceiling.depth_frames[1], 1);
  EXPECT_EQ(ceiling.depth_frames[0], 0);
  EXPECT_EQ(ceiling.value_at_5, 1234);
  EXPECT_EQ(ceiling.ingest->health()[1].frames, 1U);
  EXPECT_EQ(ceiling.ingest->seen_until(), 50) << "nor for the one that is still silent";
}

TEST(Ingest, PointsArriveToo) {
  Ceiling ceiling(122);
  const auto publisher = wire::PointsPublisher::create(ceiling.seat, "ceiling0");
  ASSERT_TRUE(publisher);
  ASSERT_TRUE(eventually([&] { return publisher->readers() == 1; }));
  const float nan = std::numeric_limits<float>::quiet_NaN();
  ASSERT_TRUE(publisher->publish(1, Cloud{{{1, 2, 3}, {nan, 0, 0}, {4, 5, 6}}, {}}));
  ASSERT_TRUE(eventually([&] { return ceiling.point_frames[0] == 1; }));
  EXPECT_EQ(ceiling.points, 2U);
}

TEST(Ingest, FramesOfAnotherSizeAreCountedAndNamed) {
  Ceiling ceiling(123);
  Camera wide = kCamera;
  wide.width = 40;
  const auto publisher = wire::DepthPublisher::create(ceiling.seat, "ceiling0", wide);
  ASSERT_TRUE(publisher);
  ASSERT_TRUE(eventually([&] { return publisher->readers() == 1; }));
  ASSERT_TRUE(publisher->publish(image(1, 40)));
  ASSERT_TRUE(
      eventually([&] { return ceiling.ingest->health()[0].malformed == 2; }));  // the image and its info
  const auto health = ceiling.ingest->health()[0];
  EXPECT_EQ(health.state, LidarState::malformed);
  EXPECT_NE(health.last_error.find("40 x 24"), std::string::npos) << health.last_error;
  EXPECT_NE(health.last_error.find("32 x 24"), std::string::npos) << health.last_error;
  EXPECT_EQ(ceiling.depth_frames[0], 0);
}

TEST(Ingest, WhatTheGlobalCloudRefusesIsCounted) {
  Ceiling ceiling(124);
  const auto publisher = wire::DepthPublisher::create(ceiling.seat, "ceiling0", kCamera);
  ASSERT_TRUE(publisher);
  ASSERT_TRUE(eventually([&] { return publisher->readers() == 1; }));
  ASSERT_TRUE(publisher->publish(image(666)));
  ASSERT_TRUE(eventually([&] { return ceiling.ingest->health()[0].malformed == 1; }));
  EXPECT_EQ(ceiling.ingest->health()[0].last_error, "stamp is 666");
  EXPECT_EQ(ceiling.told, 0);
}

TEST(Ingest, ASilentLidarIsReportedAndComesBack) {
  Ceiling ceiling(125);
  {
    const auto publisher = wire::DepthPublisher::create(ceiling.seat, "ceiling0", kCamera);
    ASSERT_TRUE(publisher);
    ASSERT_TRUE(eventually([&] { return publisher->readers() == 1; }));
    ASSERT_TRUE(publisher->publish(image(1)));
    ASSERT_TRUE(eventually([&] { return ceiling.ingest->health()[0].state == LidarState::ok; }));
  }
  ASSERT_TRUE(eventually([&] { return ceiling.ingest->health()[0].state == LidarState::silent; }));
  const auto publisher = wire::DepthPublisher::create(ceiling.seat, "ceiling0", kCamera);
  ASSERT_TRUE(publisher);
  StampNs stamp_ns = 100;
  EXPECT_TRUE(eventually([&] {
    return publisher->publish(image(++stamp_ns)) && ceiling.ingest->health()[0].state == LidarState::ok;
  }));
}

/// Sends an image of each LiDAR at 10 Hz, stamped by the wall clock plus `ahead_s` of the second.
struct Streams {
  explicit Streams(Ceiling& ceiling)
      : publishers{wire::DepthPublisher::create(ceiling.seat, "ceiling0", kCamera).value(),
                   wire::DepthPublisher::create(ceiling.seat, "ceiling1", kCamera).value()} {
    EXPECT_TRUE(eventually([&] { return publishers[0].readers() == 1 && publishers[1].readers() == 1; }));
  }
  void send(std::uint16_t second_units, double ahead_s) {
    const StampNs now_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(
                               std::chrono::system_clock::now().time_since_epoch())
                               .count();
    DepthImage second = image(now_ns + from_seconds(ahead_s));
    std::ranges::fill(second.units, second_units);
    EXPECT_TRUE(publishers[0].publish(image(now_ns)));
    EXPECT_TRUE(publishers[1].publish(second));
    std::this_thread::sleep_for(100ms);
  }
  bool reaches(Ceiling& ceiling, LidarState state, std::uint16_t units, double ahead_s = 0) {
    for (int i = 0; i < 60; ++i) {
      send(units, ahead_s);
      if (ceiling.ingest->health()[1].state == state) return true;
    }
    return false;
  }
  std::array<wire::DepthPublisher, 2> publishers;
};

TEST(Ingest, ALidarWithoutReturnsIsBlindAndOneInAnotherUnitIsImplausible) {
  Ceiling ceiling(127);
  Streams streams(ceiling);
  EXPECT_TRUE(streams.reaches(ceiling, LidarState::blind, 0));
  EXPECT_LT(ceiling.ingest->health()[1].returns, 0.01);
  EXPECT_TRUE(streams.reaches(ceiling, LidarState::ok, 2000));
  EXPECT_TRUE(streams.reaches(ceiling, LidarState::implausible, 20'000)) << "a tenth of a millimetre";
  EXPECT_NEAR(ceiling.ingest->health()[1].range_m, 20, 1e-3);
  EXPECT_TRUE(streams.reaches(ceiling, LidarState::ok, 2000));
  EXPECT_TRUE(streams.reaches(ceiling, LidarState::blind, 65535)) << "the largest value is no return";
  EXPECT_EQ(ceiling.ingest->health()[0].state, LidarState::ok);
}

TEST(Ingest, AClockAheadIsLeftOutThenCorrectedAndTold) {
  Ceiling ceiling(128);
  Streams streams(ceiling);
  EXPECT_TRUE(streams.reaches(ceiling, LidarState::clock_off, 2000, 37));
  EXPECT_TRUE(streams.reaches(ceiling, LidarState::ok, 2000, 37));
  const auto health = ceiling.ingest->health()[1];
  EXPECT_TRUE(health.clock_corrected);
  EXPECT_NEAR(health.clock_offset_s, 37, 0.1);
  streams.send(2000, 37);
  EXPECT_NEAR(to_seconds(ceiling.newest_ns[1] - ceiling.newest_ns[0]), 0, 0.15);
  EXPECT_FALSE(ceiling.ingest->health()[0].clock_corrected);
}

TEST(Ingest, ASiteWithoutLidarsIsRefused) {
  const auto seat = wire::Participant::create({.domain = 126, .role = wire::Role::server});
  ASSERT_TRUE(seat);
  auto dispatcher = wire::Dispatcher::create(*seat).value();
  EXPECT_FALSE(Ingest::create(*dispatcher, Site{}, {}));
}

}  // namespace
}  // namespace liloc
