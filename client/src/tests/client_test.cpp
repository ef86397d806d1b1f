#include "client/include/liloc/client.hpp"  // first: it must stand on its own

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "client/src/tests/walk.hpp"
#include "common/wire/server_link.hpp"

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

/// A server that knows the answer: odometry lies at (1, 2, 3).
class FakeServer {
 public:
  FakeServer() {
    auto joined = wire::Participant::create({.domain = kDomain, .role = wire::Role::server});
    EXPECT_TRUE(joined) << (joined ? "" : joined.error().message);
    participant_ = std::move(*joined);
    dispatcher_ = std::move(*wire::Dispatcher::create(*participant_));
    wire::ServerCallbacks callbacks;
    callbacks.on_request = [this](const wire::Arrival& arrival) {
      SpotReply reply = refusal(arrival.request, Reason::none, "");
      reply.status = SpotStatus::verified;
      reply.reason = Reason::confirmed;
      reply.T_map_odom = Pose(Eigen::Translation3d(1, 2, 3));
      reply.T_map_sensor = *reply.T_map_odom * arrival.request.T_odom_sensor;
      reply.covariance = 1e-4 * Matrix6d::Identity();
      EXPECT_TRUE(link_->reply(arrival.from, reply));
      ++answered;
    };
    link_ = std::move(*wire::ServerLink::create(*dispatcher_, {}, callbacks));
    dispatcher_->start();
  }
  ~FakeServer() { dispatcher_->stop(); }

  std::atomic<int> answered = 0;

 private:
  std::optional<wire::Participant> participant_;
  std::unique_ptr<wire::Dispatcher> dispatcher_;
  std::unique_ptr<wire::ServerLink> link_;
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
      EXPECT_TRUE(client_.push_depth(image.units.data(), image.width, image.height, image.stamp_ns));
      std::this_thread::sleep_for(10ms);
    }
    return condition(client_.newest());
  }

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
  ASSERT_TRUE(
      feeder.until([](const auto& pose) { return pose.state == State::tracking && pose.T_map_sensor; }));
  const auto pose = client.newest();
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(pose.T_map_sensor->translation_m[i], pose.T_odom_sensor.translation_m[i] + i + 1, 1e-9);
  EXPECT_TRUE(pose.server_connected);

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

TEST(Client, WrongInputIsRefusedAndCountsNothing) {
  auto made = Client::create(options());
  ASSERT_TRUE(made) << made.error();
  Client& client = *made.value();
  const std::vector<std::uint16_t> units(100, 1000);
  EXPECT_THAT(client.push_depth(units.data(), 10, 10, 1).error(), HasSubstr("10x10"));
  EXPECT_FALSE(client.push_depth(nullptr, 160, 120, 1));
  EXPECT_THAT(client.push_imu(1, {0, 0, 0}, {0, 0, 9.81}).error(), HasSubstr("T_imu_sensor"));
  EXPECT_EQ(client.newest().stamp_ns, 0);
  ASSERT_TRUE(client.stop());
  EXPECT_EQ(client.stats().frames, 0U);
  const DepthImage image = covered_at(0);
  EXPECT_THAT(client.push_depth(image.units.data(), 160, 120, 1).error(), HasSubstr("stopped"));
  EXPECT_TRUE(client.stop());
}

}  // namespace
}  // namespace liloc
