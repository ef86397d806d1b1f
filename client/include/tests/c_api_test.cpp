// Wrong use of the C API is a status with a remedy, never an abort.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "client/include/liloc/client.h"
#include "client/include/tests/consumer/box_frames.h"

namespace {

using testing::HasSubstr;
using namespace std::chrono_literals;

constexpr int kDomain = 176, kAnsweredDomain = 177;  // of this test alone
constexpr int kWidth = 32, kHeight = 24;

liloc_client_options good_options() {
  liloc_client_options o;
  EXPECT_EQ(liloc_client_options_init(&o, sizeof o), LILOC_OK);
  o.id = "c-api";
  o.domain = kDomain;
  o.camera = {kWidth, kHeight, 24, 24, 15.5, 11.5, 0.001};
  return o;
}

std::string error() {
  return liloc_client_last_error();
}

struct Destroy {
  void operator()(liloc_client* client) const { EXPECT_EQ(liloc_client_destroy(client), LILOC_OK) << error(); }
};
using Handle = std::unique_ptr<liloc_client, Destroy>;

Handle created(const liloc_client_options& options = good_options()) {
  liloc_client* client = nullptr;
  EXPECT_EQ(liloc_client_create(&options, sizeof options, &client), LILOC_OK) << error();
  return Handle(client);
}

liloc_status push(liloc_client* client, std::int64_t stamp_ns, std::uint16_t units = 2000) {
  const std::vector<std::uint16_t> image(kWidth * kHeight, units);
  return liloc_client_push_depth(client, image.data(), kWidth, kHeight, stamp_ns);
}

bool within(std::chrono::seconds limit, const std::function<bool()>& holds) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (!holds() && std::chrono::steady_clock::now() < end) std::this_thread::sleep_for(1ms);
  return holds();
}

TEST(CApi, DefaultsAreThoseOfTheLibrary) {
  const liloc_client_options o = good_options();
  EXPECT_STREQ(o.network_interface, "lo");
  EXPECT_EQ(o.interval_ms, 800);
  EXPECT_DOUBLE_EQ(o.voxel_size_m, 0.05);
  EXPECT_EQ(o.queue_frames, 4U);
  EXPECT_DOUBLE_EQ(o.T_imu_sensor.rotation_xyzw[3], 1);
  EXPECT_EQ(o.trace_folder, nullptr);
}

TEST(CApi, NullIsRefusedEverywhere) {
  const liloc_client_options o = good_options();
  const Handle client = created();
  const double three[3] = {0, 0, 0};
  liloc_pose_update update;
  liloc_stats stats;
  const std::vector<std::function<liloc_status()>> calls{
      [] { return liloc_client_options_init(nullptr, sizeof(liloc_client_options)); },
      [&] { return liloc_client_create(&o, sizeof o, nullptr); },
      [] { return liloc_client_on_pose(nullptr, nullptr, nullptr); },
      [] { return liloc_client_on_reply(nullptr, nullptr, nullptr); },
      [] { return liloc_client_start(nullptr); },
      [] { return push(nullptr, 1); },
      [&] { return liloc_client_push_depth(client.get(), nullptr, kWidth, kHeight, 1); },
      [&] { return liloc_client_push_imu(nullptr, 1, three, three); },
      [&] { return liloc_client_push_imu(client.get(), 1, nullptr, three); },
      [&] { return liloc_client_push_imu(client.get(), 1, three, nullptr); },
      [&] { return liloc_client_push_points(client.get(), nullptr, 1, 1); },
      [&] { return liloc_client_push_odometry(client.get(), 1, nullptr, three); },
      [&] { return liloc_client_newest(nullptr, &update, sizeof update); },
      [&] { return liloc_client_stats(nullptr, &stats, sizeof stats); },
      [] { return liloc_client_stop(nullptr); }};
  for (std::size_t i = 0; i < calls.size(); ++i) {
    EXPECT_EQ(calls[i](), LILOC_INVALID_ARGUMENT) << "call " << i;
    EXPECT_THAT(error(), HasSubstr("NULL")) << "call " << i;
  }
  EXPECT_EQ(liloc_client_destroy(nullptr), LILOC_OK);
}

TEST(CApi, WrongOptionsAreNamedAtCreate) {
  const char* const no_host[] = {nullptr};
  const std::vector<std::pair<std::function<void(liloc_client_options&)>, const char*>> cases{
      {[](auto& o) { o.id = nullptr; }, "options.id"},
      {[](auto& o) { o.network_interface = nullptr; }, "options.network_interface"},
      {[](auto& o) { o.domain = 231; }, "options.domain is 231"},
      {[](auto& o) { o.domain = -1; }, "options.domain is -1"},
      {[](auto& o) { o.local = 4; }, "options.local is 4"},
      {[](auto& o) { o.peer_count = 2; }, "options.peers is NULL"},
      {[&](auto& o) {
         o.peers = no_host;
         o.peer_count = 1;
       },
       "options.peers[0]"}};
  for (const auto& [spoil, text] : cases) {
    liloc_client_options o = good_options();
    spoil(o);
    liloc_client* client = reinterpret_cast<liloc_client*>(&o);
    EXPECT_EQ(liloc_client_create(&o, sizeof o, &client), LILOC_INVALID_ARGUMENT) << text;
    EXPECT_THAT(error(), HasSubstr(text));
    EXPECT_EQ(client, nullptr);
  }
}

TEST(CApi, WrongOptionsAreNamedAtStart) {
  const std::vector<std::pair<std::function<void(liloc_client_options&)>, const char*>> cases{
      {[](auto& o) { o.id = "no blanks please"; }, "options.id"},
      {[](auto& o) { o.camera.fx = 0; }, "options.camera.fx"},
      {[](auto& o) { o.camera.width = -3; }, "options.camera.width"},
      {[](auto& o) { o.voxel_size_m = std::numeric_limits<double>::quiet_NaN(); }, "options.voxel_size_m"},
      {[](auto& o) { o.local = LILOC_LOCAL_INERTIAL; }, "options.T_imu_sensor"},
      {[](auto& o) {
         o.has_imu = true;
         o.T_imu_sensor.rotation_xyzw[3] = 0;
       },
       "options.T_imu_sensor"}};
  for (const auto& [spoil, text] : cases) {
    liloc_client_options o = good_options();
    spoil(o);
    const Handle client = created(o);
    EXPECT_EQ(liloc_client_start(client.get()), LILOC_INVALID_ARGUMENT) << text;
    EXPECT_THAT(error(), HasSubstr(text));
  }
}

TEST(CApi, TheNetworksErrorIsNotTheCallers) {
  liloc_client_options o = good_options();
  o.network_interface = "nosuchcard0";
  const Handle client = created(o);
  EXPECT_EQ(liloc_client_start(client.get()), LILOC_FAILED);
  EXPECT_THAT(error(), HasSubstr("nosuchcard0"));
}

TEST(CApi, StructuresGrowWithoutBreakingPrograms) {
  struct Newer {  // of a header that came after this library
    liloc_client_options options;
    std::int64_t later;
  } newer{};
  ASSERT_EQ(liloc_client_options_init(&newer.options, sizeof newer), LILOC_OK);
  EXPECT_EQ(newer.later, 0);
  newer.options.id = "newer";
  liloc_client* client = nullptr;
  EXPECT_EQ(liloc_client_create(&newer.options, sizeof newer, &client), LILOC_OK) << error();
  EXPECT_EQ(liloc_client_destroy(client), LILOC_OK);
  newer.later = 1;
  EXPECT_EQ(liloc_client_create(&newer.options, sizeof newer, &client), LILOC_INVALID_ARGUMENT);
  EXPECT_THAT(error(), HasSubstr("does not know"));

  for (const std::size_t size : {std::size_t{0}, std::size_t{8}, std::numeric_limits<std::size_t>::max()}) {
    EXPECT_EQ(liloc_client_options_init(&newer.options, size), LILOC_INVALID_ARGUMENT) << size;
    EXPECT_EQ(liloc_client_create(&newer.options, size, &client), LILOC_INVALID_ARGUMENT) << size;
    EXPECT_THAT(error(), HasSubstr("sizeof(liloc_client_options)"));
  }
}

TEST(CApi, TheOrderOfCallsIsHeld) {
  const Handle client = created();
  liloc_pose_update update;
  liloc_stats stats;
  EXPECT_EQ(push(client.get(), 1), LILOC_WRONG_STATE);
  EXPECT_THAT(error(), HasSubstr("liloc_client_start"));
  EXPECT_EQ(liloc_client_newest(client.get(), &update, sizeof update), LILOC_WRONG_STATE);
  EXPECT_EQ(liloc_client_stats(client.get(), &stats, sizeof stats), LILOC_WRONG_STATE);

  ASSERT_EQ(liloc_client_start(client.get()), LILOC_OK) << error();
  EXPECT_EQ(liloc_client_start(client.get()), LILOC_WRONG_STATE);
  EXPECT_THAT(error(), HasSubstr("already started"));
  EXPECT_EQ(liloc_client_on_pose(client.get(), nullptr, nullptr), LILOC_WRONG_STATE);
  ASSERT_EQ(liloc_client_newest(client.get(), &update, sizeof update), LILOC_OK);
  EXPECT_EQ(update.stamp_ns, 0);
  EXPECT_FALSE(update.has_map);

  EXPECT_EQ(liloc_client_stop(client.get()), LILOC_OK);
  EXPECT_EQ(liloc_client_stop(client.get()), LILOC_OK);
  EXPECT_EQ(push(client.get(), 2), LILOC_WRONG_STATE);
  EXPECT_THAT(error(), HasSubstr("create another client"));
  EXPECT_EQ(liloc_client_start(client.get()), LILOC_WRONG_STATE);
  EXPECT_EQ(liloc_client_stats(client.get(), &stats, sizeof stats), LILOC_OK);
}

TEST(CApi, WrongSamplesAreRefused) {
  liloc_client_options o = good_options();
  const Handle without_imu = created(o);
  o.id = "c-api-imu";
  o.has_imu = true;
  const Handle client = created(o);
  ASSERT_EQ(liloc_client_start(client.get()), LILOC_OK) << error();
  ASSERT_EQ(liloc_client_start(without_imu.get()), LILOC_OK) << error();
  const std::vector<std::uint16_t> image(kWidth * kHeight);
  EXPECT_EQ(liloc_client_push_depth(client.get(), image.data(), kHeight, kWidth, 1), LILOC_INVALID_ARGUMENT);
  EXPECT_THAT(error(), HasSubstr("24x32"));
  const double fine[3] = {0, 0, 9.81}, broken[3] = {0, std::nan(""), 0};
  EXPECT_EQ(liloc_client_push_imu(client.get(), 1, fine, fine), LILOC_OK) << error();
  EXPECT_EQ(liloc_client_push_imu(client.get(), 1, fine, broken), LILOC_INVALID_ARGUMENT);
  EXPECT_THAT(error(), HasSubstr("finite"));
  EXPECT_EQ(liloc_client_push_imu(without_imu.get(), 1, fine, fine), LILOC_INVALID_ARGUMENT);
  EXPECT_THAT(error(), HasSubstr("has_imu"));
  liloc_pose_update update;
  EXPECT_EQ(liloc_client_newest(client.get(), &update, 4), LILOC_INVALID_ARGUMENT);
  EXPECT_EQ(liloc_client_newest(client.get(), nullptr, sizeof update), LILOC_INVALID_ARGUMENT);
}

TEST(CApi, PointsAndExternalOdometryMoveThePose) {
  liloc_client_options o = good_options();
  o.local = LILOC_LOCAL_EXTERNAL;
  const Handle client = created(o);
  ASSERT_EQ(liloc_client_start(client.get()), LILOC_OK) << error();
  std::vector<float> wall;
  for (int y = -40; y <= 40; ++y)
    for (int x = -40; x <= 40; ++x)
      wall.insert(wall.end(), {0.04F * static_cast<float>(x), 0.04F * static_cast<float>(y), 2.5F});
  liloc_pose_update now{};
  liloc_pose T = o.T_base_sensor;
  for (int i = 0; i < 20; ++i) {
    T.translation_m[0] = 0.01 * i;
    ASSERT_EQ(liloc_client_push_odometry(client.get(), frame_stamp_ns(i), &T, nullptr), LILOC_OK) << error();
    ASSERT_EQ(liloc_client_push_points(client.get(), wall.data(), wall.size() / 3, frame_stamp_ns(i)),
              LILOC_OK);
    EXPECT_TRUE(within(20s,
                       [&] {
                         return liloc_client_newest(client.get(), &now, sizeof now) == LILOC_OK &&
                                now.stamp_ns == frame_stamp_ns(i);
                       }))
        << "frame " << i;
  }
  EXPECT_NEAR(now.T_odom_sensor.translation_m[0], 0.19, 1e-6);
  T.rotation_xyzw[3] = 0;
  EXPECT_EQ(liloc_client_push_odometry(client.get(), frame_stamp_ns(20), &T, nullptr), LILOC_INVALID_ARGUMENT);
}

struct Attempts {
  liloc_client* client = nullptr;
  std::atomic<int> calls = 0, refused = 0;
};

void try_to_stop(const liloc_pose_update* /*update*/, void* user) {
  auto& attempts = *static_cast<Attempts*>(user);
  attempts.refused += liloc_client_stop(attempts.client) == LILOC_WRONG_STATE;
  attempts.refused += liloc_client_destroy(attempts.client) == LILOC_WRONG_STATE;
  attempts.refused += error().find("another thread") != std::string::npos;
  ++attempts.calls;
}

TEST(CApi, ACallbackThatStopsItsClientIsRefused) {
  const Handle client = created();
  Attempts attempts{client.get()};
  ASSERT_EQ(liloc_client_on_pose(client.get(), try_to_stop, &attempts), LILOC_OK);
  ASSERT_EQ(liloc_client_start(client.get()), LILOC_OK) << error();
  ASSERT_EQ(push(client.get(), 1), LILOC_OK) << error();
  EXPECT_TRUE(within(20s, [&] { return attempts.calls == 1; }));
  EXPECT_EQ(liloc_client_stop(client.get()), LILOC_OK) << error();
  EXPECT_EQ(attempts.refused, 3);
}

struct Answers {
  std::mutex mutex;
  int verified = 0;
  liloc_reply last{};
  std::string status, reason, text;
};

void take_reply(const liloc_reply* reply, void* user) {
  auto& answers = *static_cast<Answers*>(user);
  const std::scoped_lock lock(answers.mutex);
  answers.verified += reply->verified;
  answers.last = *reply;
  answers.status = reply->status;
  answers.reason = reply->reason;
  answers.text = reply->text;
}

/// Feeds the walk, again and again at one place, until the newest pose is global.
bool located(liloc_client* client, liloc_pose_update& update) {
  std::vector<std::uint16_t> units(FRAME_WIDTH * FRAME_HEIGHT);
  render_frame(0, units.data());
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(liloc_client_push_depth(client, units.data(), FRAME_WIDTH, FRAME_HEIGHT, frame_stamp_ns(i)),
              LILOC_OK);
    std::this_thread::sleep_for(10ms);
    EXPECT_EQ(liloc_client_newest(client, &update, sizeof update), LILOC_OK);
    if (update.has_map) return true;
  }
  return false;
}

TEST(CApi, RepliesLocateTheClient) {
  FILE* const server = popen((ANSWERING_SERVER " " + std::to_string(kAnsweredDomain)).c_str(), "w");
  ASSERT_NE(server, nullptr);
  liloc_client_options o = good_options();
  o.domain = kAnsweredDomain;
  o.interval_ms = 100;
  o.camera = {FRAME_WIDTH, FRAME_HEIGHT, FOCAL_PX, FOCAL_PX, (FRAME_WIDTH - 1) / 2.0, (FRAME_HEIGHT - 1) / 2.0,
              UNIT_M};
  Answers answers;
  liloc_pose_update now{};
  {
    const Handle client = created(o);
    ASSERT_EQ(liloc_client_on_reply(client.get(), take_reply, &answers), LILOC_OK);
    ASSERT_EQ(liloc_client_start(client.get()), LILOC_OK) << error();
    EXPECT_TRUE(located(client.get(), now));
  }
  EXPECT_EQ(pclose(server), 0);
  EXPECT_EQ(now.state, LILOC_TRACKING);
  EXPECT_TRUE(now.server_connected);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(now.T_map_sensor.translation_m[i], now.T_odom_sensor.translation_m[i] + 1 + i, 1e-6);
  EXPECT_GE(answers.verified, 1);
  EXPECT_TRUE(answers.last.has_map);
  EXPECT_EQ(answers.status + " " + answers.reason + " " + answers.text, "verified confirmed by heart");
  EXPECT_NEAR(answers.last.covariance[7], 1e-4, 1e-9);
  EXPECT_EQ(answers.last.covariance[1], 0);
  EXPECT_NEAR(answers.last.T_map_sensor.translation_m[2], 3, 0.1);
}

TEST(CApi, ManyThreadsMayPushWhileOneStops) {
  const Handle client = created();
  ASSERT_EQ(liloc_client_start(client.get()), LILOC_OK) << error();
  std::atomic<int> pushing = 0, unexpected = 0;
  std::vector<std::jthread> threads;
  for (int t = 0; t < 3; ++t)
    threads.emplace_back([&, t] {
      for (int i = 0;; ++i) {
        const liloc_status status = push(client.get(), 1 + i * 3 + t);
        if (status == LILOC_WRONG_STATE) return;
        unexpected += status != LILOC_OK;
        ++pushing;
      }
    });
  EXPECT_TRUE(within(20s, [&] { return pushing > 100; }));
  EXPECT_EQ(liloc_client_stop(client.get()), LILOC_OK) << error();
  threads.clear();
  EXPECT_EQ(unexpected, 0);
}

TEST(CApi, ErrorsBelongToTheirThread) {
  EXPECT_EQ(liloc_client_stop(nullptr), LILOC_INVALID_ARGUMENT);
  std::string other = "not run";
  std::thread([&] { other = error(); }).join();
  EXPECT_EQ(other, "");
  EXPECT_NE(error(), "");
}

TEST(CApi, StatusesHaveNames) {
  EXPECT_STREQ(liloc_client_status_name(LILOC_OK), "LILOC_OK");
  EXPECT_STREQ(liloc_client_status_name(LILOC_INTERNAL), "LILOC_INTERNAL");
  EXPECT_STREQ(liloc_client_status_name(6), "unknown status");
  EXPECT_STREQ(liloc_client_status_name(-1), "unknown status");
}

}  // namespace
