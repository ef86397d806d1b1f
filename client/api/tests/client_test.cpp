#include "client/include/liloc/client.hpp"  // first: it must stand on its own

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "client/api/tests/by_heart_server.hpp"
#include "common/geometry/depth.hpp"
#include "common/testing/walk.hpp"
#include "common/wire/spots/status.hpp"

namespace liloc {
namespace {

using namespace test;
using namespace std::chrono_literals;
using client::Client;
using client::Options;
using client::State;
using ::testing::HasSubstr;

constexpr int kDomain = 141;  // of this test alone

Options options() {
  const Camera c = scene::small_camera();
  Options o;
  o.id = "walker";
  o.domain = kDomain;
  o.camera = {c.width, c.height, c.fx, c.fy, c.cx, c.cy, c.depth_scale_m};
  o.interval_ms = 200;
  o.queue_frames = 50;
  return o;
}

const auto kBegin = std::chrono::steady_clock::now();

/// A server that knows the answer and the time, and remembers what it was asked.
class FakeServer {
 public:
  explicit FakeServer(const std::string& id = "edge1") {
    auto started = ByHeartServer::start(kDomain, id, [this](const wire::Arrival& arrival, SpotReply& reply) {
      reply.server_received_ns = ceiling_ns(arrival.at);
      reply.server_sent_ns = ceiling_ns(std::chrono::steady_clock::now());
      last_ceiling_stamp_ns = arrival.request.ceiling_stamp_ns;
      last_stamp_ns = arrival.request.stamp_ns;
      last_codec = arrival.request.lpc.codec;
      ++answered;
    });
    EXPECT_TRUE(started) << (started ? "" : started.error().message);
    server_ = std::move(*started);
  }

  /// The ceiling's clock: kStart at kBegin.
  static StampNs ceiling_ns(std::chrono::steady_clock::time_point at) {
    return kStart + std::chrono::nanoseconds(at - kBegin).count();
  }

  std::atomic<int> answered = 0;
  std::atomic<CloudCodec> last_codec{};
  std::atomic<StampNs> last_stamp_ns = 0, last_ceiling_stamp_ns = 0;

 private:
  std::unique_ptr<ByHeartServer> server_;
};

/// Feeds frames, ten times faster than life, until the condition holds.
class Feeder {
 public:
  explicit Feeder(Client& client) : client_(client), room_(scene::furnished_room(1)) {}
  template <class Condition>
  bool until(Condition&& condition, int most_frames = 400) {
    for (int i = 0; i < most_frames; ++i) {
      if (condition(client_.newest())) return true;
      const DepthImage image = frame_at(room_, frame_++);
      EXPECT_TRUE(client_.push_depth(image.units.data(), image.width, image.height, image.stamp_ns + off_ns));
      std::this_thread::sleep_for(10ms);
    }
    return condition(client_.newest());
  }

  StampNs off_ns = 0;  ///< of the stamps

 private:
  Client& client_;
  scene::BoxRoom room_;
  int frame_ = 0;
};

TEST(ClientOptions, WhatIsWrongIsNamed) {
  const auto error_of = [](auto&& change) {
    Options o = options();
    change(o);
    const auto made = Client::create(o);
    return made ? std::string("accepted") : made.error();
  };
  EXPECT_THAT(error_of([](Options& o) { o.id = "a b"; }), HasSubstr("options.id"));
  EXPECT_THAT(error_of([](Options& o) { o.camera.fx = -1; }), HasSubstr("options.camera.fx"));
  EXPECT_THAT(error_of([](Options& o) { o.interval_ms = 0; }), HasSubstr("options.interval_ms is 0"));
  EXPECT_THAT(error_of([](Options& o) { o.searching_interval_ms = -1; }),
              HasSubstr("searching_interval_ms is -1"));
  EXPECT_THAT(error_of([](Options& o) { o.request_bytes = 1999; }), HasSubstr("options.request_bytes is 1999"));
  EXPECT_THAT(error_of([](Options& o) { o.voxel_size_m = NAN; }), HasSubstr("options.voxel_size_m"));
  EXPECT_THAT(error_of([](Options& o) { o.local = client::Local::inertial; }), HasSubstr("T_imu_sensor"));
  EXPECT_THAT(error_of([](Options& o) {
                o.T_imu_sensor.emplace().rotation_xyzw = {0, 0, 0, 0};
              }),
              HasSubstr("options.T_imu_sensor"));
  EXPECT_THAT(error_of([](Options& o) { o.domain = 999; }), HasSubstr("domain is 999"));
}

TEST(Client, TracksCoastsAndComesBackWithTheServer) {
  std::atomic<int> poses = 0, verified = 0;
  auto server = std::make_unique<FakeServer>();
  auto made = Client::create(
      options(), [&](const client::PoseUpdate&) { ++poses; },
      [&](const client::Reply& reply) {
        verified += reply.verified;
        EXPECT_EQ(reply.reason, "confirmed");
        EXPECT_DOUBLE_EQ(reply.covariance[7], 1e-4);
      });
  ASSERT_TRUE(made) << made.error();
  Client& client = *made.value();
  Feeder feeder(client);
  ASSERT_TRUE(feeder.until([](const auto& pose) {
    return pose.state == State::tracking && pose.T_map_sensor && pose.server_connected;
  }));
  const auto pose = client.newest();
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(pose.T_map_sensor->translation_m[i], pose.T_odom_sensor.translation_m[i] + i + 1, 1e-9);
  server.reset();
  ASSERT_TRUE(feeder.until([](const auto& p) { return p.state == State::coasting; }));
  EXPECT_TRUE(client.newest().T_map_sensor);  // goes on by itself
  EXPECT_FALSE(client.newest().server_connected);
  EXPECT_GT(client.stats().requests_unsent, 0U);

  server = std::make_unique<FakeServer>();
  ASSERT_TRUE(feeder.until([](const auto& p) { return p.state == State::tracking; }));
  ASSERT_TRUE(client.stop());
  const auto stats = client.stats();
  EXPECT_EQ(static_cast<std::uint64_t>(poses), stats.frames);
  EXPECT_EQ(static_cast<std::uint64_t>(verified), stats.replies_verified);
  EXPECT_GT(stats.frame_ms_median, 0.0);
}

TEST(Client, AStandbyTakesOver) {
  auto first = std::make_unique<FakeServer>("edge1");
  const FakeServer standby("edge2");
  auto made = Client::create(options());
  ASSERT_TRUE(made) << made.error();
  Client& client = *made.value();
  Feeder feeder(client);
  ASSERT_TRUE(feeder.until([&](const auto& pose) {
    return pose.state == State::tracking && first->answered > 3 && standby.answered > 3;
  }));
  const auto before = client.stats();
  EXPECT_LE(before.replies, before.requests);  // one answer to each, of the two that come
  first.reset();
  bool lost = false;
  ASSERT_TRUE(feeder.until([&](const auto& pose) {
    lost |= !pose.T_map_sensor;
    return pose.state == State::tracking && client.stats().replies_verified > before.replies_verified + 5;
  }));
  EXPECT_FALSE(lost);
  EXPECT_TRUE(client.newest().server_connected);
}

TEST(Client, CloudsTravelAsWhatTheServerReads) {
  FakeServer server;
  const auto participant = wire::Participant::create({.domain = kDomain, .role = wire::Role::server});
  ASSERT_TRUE(participant) << participant.error().message;
  const auto teller = wire::StatusPublisher::create(*participant);
  ASSERT_TRUE(teller) << teller.error().message;
  auto made = Client::create(options());
  ASSERT_TRUE(made) << made.error();
  Feeder feeder(*made.value());
  EXPECT_TRUE(feeder.until([&](const auto&) { return server.last_codec == CloudCodec::draco; }));
  wire::ServerStatus status;
  status.server_id = "edge1";
  status.codecs = {static_cast<CloudCodec>(77), CloudCodec::octree, CloudCodec::voxel};
  ASSERT_TRUE(teller->publish(status));
  EXPECT_TRUE(feeder.until([&](const auto&) { return server.last_codec == CloudCodec::voxel; }));
  status.codecs = {CloudCodec::draco};  // updated
  ASSERT_TRUE(teller->publish(status));
  EXPECT_TRUE(feeder.until([&](const auto&) { return server.last_codec == CloudCodec::draco; }));
}

/// At the pace of life, by a clock that runs ahead of the ceiling's.
void feed_ahead(Client& client, double ahead_ms, int frames) {
  DepthImage image = frame_at(scene::furnished_room(1), 0);
  for (int i = 0; i < frames; ++i) {
    image.stamp_ns = FakeServer::ceiling_ns(std::chrono::steady_clock::now()) + from_ms(ahead_ms);
    EXPECT_TRUE(client.push_depth(image.units.data(), image.width, image.height, image.stamp_ns));
    std::this_thread::sleep_for(30ms);
  }
}

/// A client that asks often, and its server.
class Clocks : public testing::Test {
 protected:
  void SetUp() override {
    Options o = options();
    o.interval_ms = 100;
    auto made = Client::create(o);
    ASSERT_TRUE(made) << made.error();
    client = std::move(made.value());
  }
  FakeServer server;
  std::unique_ptr<Client> client;
};

TEST_F(Clocks, OneThatRunsAheadIsFoundAndRequestsCarryTheCeilingsTime) {
  feed_ahead(*client, 70, 60);
  const auto stats = client->stats();
  EXPECT_TRUE(stats.clock_good);
  EXPECT_NEAR(stats.clock_offset_ms, 70, 10);
  EXPECT_EQ(stats.clock_jumps, 0U);
  ASSERT_NE(server.last_ceiling_stamp_ns, 0);
  EXPECT_NEAR(to_ms(server.last_stamp_ns - server.last_ceiling_stamp_ns), 70, 10);

  feed_ahead(*client, 2070, 40);  // somebody set it
  const auto after = client->stats();
  EXPECT_EQ(after.clock_jumps, 1U);
  EXPECT_NEAR(after.clock_offset_ms, 2070, 10);
}

TEST_F(Clocks, InStepAreLeftAlone) {
  feed_ahead(*client, 2, 60);
  EXPECT_TRUE(client->stats().clock_good);
  EXPECT_GT(server.answered, 3);
  EXPECT_EQ(server.last_ceiling_stamp_ns, 0);
}

/// Wheels and clouds through the public API.
TEST(Client, OdometryOfOthersAndCloudsGoThrough) {
  FakeServer server;
  Options o = options();
  o.local = client::Local::external;
  auto made = Client::create(o);
  ASSERT_TRUE(made) << made.error();
  Client& client = *made.value();
  const auto room = scene::furnished_room(1);
  int frame = 0;
  for (double t = 0; t < 6 && client.newest().state != State::tracking; t += 0.02) {
    const Eigen::Vector3d p = walk(t).translation();
    const Eigen::Quaterniond q(walk(t).linear());
    ASSERT_TRUE(
        client.push_odometry(kStart + from_seconds(t), {{p.x(), p.y(), p.z()}, {q.x(), q.y(), q.z(), q.w()}}));
    if (time_of(frame) > t) continue;
    const auto cloud = depth_to_cloud(frame_at(room, frame), scene::small_camera(), {});
    ASSERT_TRUE(client.push_points(cloud->points.front().data(), cloud->size(), stamp_of(frame++)));
    std::this_thread::sleep_for(20ms);
  }
  ASSERT_TRUE(client.stop());
  const auto newest = client.newest();
  EXPECT_EQ(newest.state, State::tracking);
  ASSERT_TRUE(newest.T_map_sensor);
  const double t = to_seconds(newest.stamp_ns - kStart);
  EXPECT_NEAR(newest.T_map_sensor->translation_m[0], walk(t).translation().x() + 1, 0.02);
  EXPECT_THAT(client.push_points(nullptr, 1, 1).error(), HasSubstr("NULL"));
  EXPECT_THAT(client.push_odometry(1, {{0, 0, 0}, {0, 0, 0, 0}}).error(), HasSubstr("T_odom_base"));
}

TEST(Client, OdometryWithAnUnknownCovarianceIsTaken) {
  Options o = options();
  o.local = client::Local::external;
  auto made = Client::create(o);
  ASSERT_TRUE(made) << made.error();
  std::array<double, 36> unknown{};
  unknown.fill(NAN);
  const auto taken = made.value()->push_odometry(kStart, {}, unknown);
  EXPECT_TRUE(taken) << taken.error();
}

TEST(Client, AClockSetBackIsToldAndTheDeviceIsLocatedAgain) {
  FakeServer server;
  auto made = Client::create(options());
  ASSERT_TRUE(made) << made.error();
  Client& client = *made.value();
  Feeder feeder(client);
  const auto tracking = [](const auto& pose) { return pose.state == State::tracking; };
  ASSERT_TRUE(feeder.until(tracking));
  const auto segment = client.newest().odom_segment;
  feeder.off_ns = -from_seconds(10);
  ASSERT_TRUE(
      feeder.until([&](const auto& pose) { return pose.odom_segment > segment && tracking(pose); }, 45));
  EXPECT_THAT(client.stats().problem, HasSubstr("clock was set back"));
  EXPECT_LE(client.stats().frames_refused, 2U);
}

TEST(Client, NotANumberFromTheImuAndOtherUnitsAreRefusedAtOnce) {
  Options o = options();
  o.T_imu_sensor.emplace();
  auto made = Client::create(o);
  ASSERT_TRUE(made) << made.error();
  Client& client = *made.value();
  EXPECT_THAT(client.push_imu(kStart, {0, NAN, 0}, {0, 0, 9.81}).error(), HasSubstr("finite"));
  EXPECT_THAT(client.push_imu(0, {0, 0, 0}, {0, 0, 9.81}).error(), HasSubstr("not set"));
  const DepthImage image = covered_at(0);
  const auto push = [&](StampNs stamp_ns) {
    return client.push_depth(image.units.data(), 160, 120, stamp_ns).error();
  };
  const StampNs now_ns = std::chrono::system_clock::now().time_since_epoch() / 1ns;
  EXPECT_THAT(push(now_ns / 1000), HasSubstr("microseconds"));
  EXPECT_THAT(push(-now_ns), HasSubstr("not set"));
  EXPECT_EQ(client.stats().frames_refused, 2U);
  EXPECT_EQ(client.stats().imu_refused, 2U);
}

TEST(Client, OdometryOfOthersNeedsItsMethod) {
  auto made = Client::create(options());
  ASSERT_TRUE(made) << made.error();
  EXPECT_THAT(made.value()->push_odometry(1, {}).error(), HasSubstr("external"));
  Options o = options();
  o.T_base_sensor.emplace();
  EXPECT_THAT(Client::create(o).error(), HasSubstr("options.T_base_sensor"));
  o = options();
  o.cpu_share = 0;
  EXPECT_THAT(Client::create(o).error(), HasSubstr("options.cpu_share"));
}

TEST(Client, WrongInputIsRefusedCountedAndTold) {
  auto made = Client::create(options());
  ASSERT_TRUE(made) << made.error();
  Client& client = *made.value();
  const std::vector<std::uint16_t> units(100, 1000);
  EXPECT_THAT(client.push_depth(units.data(), 10, 10, 1).error(), HasSubstr("10x10"));
  EXPECT_THAT(client.stats().problem, HasSubstr("10x10"));
  EXPECT_THAT(client.push_depth(nullptr, 160, 120, 1).error(), HasSubstr("NULL"));
  EXPECT_THAT(client.push_points(nullptr, 7, 1).error(), HasSubstr("NULL"));
  EXPECT_EQ(client.stats().frames_refused, 3U);
  EXPECT_THAT(client.push_imu(1, {0, 0, 0}, {0, 0, 9.81}).error(), HasSubstr("T_imu_sensor"));
  EXPECT_EQ(client.newest().stamp_ns, 0);
  ASSERT_TRUE(client.stop());
  EXPECT_EQ(client.stats().frames, 0U);
  const DepthImage image = covered_at(0);
  EXPECT_THAT(client.push_depth(image.units.data(), 160, 120, 1).error(), HasSubstr("stopped"));
  EXPECT_TRUE(client.stop());
  EXPECT_EQ(client.stats().frames_refused, 3U) << "nothing counts after a stop";
}

/// Within ten seconds: what is missing is told after five.
bool comes_to_say(Client& client, const std::string& what, const std::function<void(int)>& meanwhile = {}) {
  for (int i = 0; i < 100; ++i, std::this_thread::sleep_for(100ms)) {
    if (meanwhile) meanwhile(i);
    if (client.stats().problem.find(what) != std::string::npos) return true;
  }
  return false;
}

TEST(ClientAlone, NamesWhatDoesNotArrive) {
  Options lonely = options();
  lonely.domain = kDomain + 1;
  lonely.frames_from = "/camera/depth";
  auto made = Client::create(lonely);
  ASSERT_TRUE(made) << made.error();
  Client& client = *made.value();
  EXPECT_TRUE(comes_to_say(client, "on /camera/depth (domain 142, interface lo)")) << client.stats().problem;
  const auto room = scene::furnished_room(1);
  const auto feed = [&](int i) {
    const DepthImage image = frame_at(room, i);
    EXPECT_TRUE(client.push_depth(image.units.data(), image.width, image.height, image.stamp_ns));
  };
  EXPECT_TRUE(comes_to_say(client, "no server is found (domain 142, interface lo)", feed))
      << client.stats().problem;
}

}  // namespace
}  // namespace liloc
