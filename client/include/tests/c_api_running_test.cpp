// A client that runs behind the C API: poses, replies, callbacks, threads.
#include <sys/resource.h>

#include <atomic>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <mutex>

#include "client/include/tests/c_api_helpers.hpp"
#include "client/include/tests/consumer/box_frames.h"

namespace {

using namespace liloc::test;
using namespace std::chrono_literals;

TEST(CApiRunning, PointsAndExternalOdometryMoveThePose) {
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
  attempts.refused += liloc_client_on_pose(attempts.client, nullptr, nullptr) == LILOC_WRONG_STATE;
  attempts.refused += liloc_client_stop(attempts.client) == LILOC_WRONG_STATE;
  attempts.refused += error().find("another thread") != std::string::npos;
  ++attempts.calls;
}

TEST(CApiRunning, ACallbackThatStopsItsClientIsRefused) {
  const Handle client = created();
  Attempts attempts{client.get()};
  ASSERT_EQ(liloc_client_on_pose(client.get(), try_to_stop, &attempts), LILOC_OK);
  ASSERT_EQ(liloc_client_start(client.get()), LILOC_OK) << error();
  ASSERT_EQ(push(client.get(), 1), LILOC_OK) << error();
  EXPECT_TRUE(within(20s, [&] { return attempts.calls == 1; }));
  EXPECT_EQ(liloc_client_stop(client.get()), LILOC_OK) << error();
  EXPECT_EQ(attempts.refused, 5);
}

void keep_line(int level, const char* line, void* user) {
  if (level == LILOC_LOG_ERROR) *static_cast<std::string*>(user) += line;
}

TEST(CApiRunning, DestroyFreesAndSaysSoWhateverTheTraceSays) {
  const auto folder = std::filesystem::temp_directory_path() / "liloc_c_api_trace";
  const std::string trace = folder.string();
  liloc_client_options o = good_options();
  o.trace_folder = trace.c_str();
  liloc_client* client = created(o).release();
  ASSERT_EQ(liloc_client_start(client), LILOC_OK) << error();
  std::string told;
  ASSERT_EQ(liloc_client_set_log(keep_line, &told), LILOC_OK);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const auto signal_before = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit full{1, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &full);
  EXPECT_EQ(push(client, frame_stamp_ns(0)), LILOC_OK);
  liloc_pose_update now{};
  EXPECT_TRUE(within(20s, [&] { return liloc_client_newest(client, &now, sizeof now) == LILOC_OK; }));
  EXPECT_EQ(liloc_client_destroy(client), LILOC_OK);
  setrlimit(RLIMIT_FSIZE, &before);
  static_cast<void>(std::signal(SIGXFSZ, signal_before));
  EXPECT_EQ(liloc_client_set_log(nullptr, nullptr), LILOC_OK);
  EXPECT_THAT(told, testing::HasSubstr("File too large"));
  std::filesystem::remove_all(folder);
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

/// Feeds one view again and again until the newest pose is global; a frame waits for the answer to the one
/// before, so that no computer is too slow for the stamps.
bool located(liloc_client* client, liloc_pose_update& update) {
  std::vector<std::uint16_t> units(FRAME_WIDTH * FRAME_HEIGHT);
  render_frame(0, units.data());
  liloc_stats stats{};
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(liloc_client_push_depth(client, units.data(), FRAME_WIDTH, FRAME_HEIGHT, frame_stamp_ns(i)),
              LILOC_OK);
    EXPECT_TRUE(within(20s, [&] {
      EXPECT_EQ(liloc_client_newest(client, &update, sizeof update), LILOC_OK);
      EXPECT_EQ(liloc_client_stats(client, &stats, sizeof stats), LILOC_OK);
      const bool answered = stats.requests == stats.requests_unsent + stats.requests_unanswered + stats.replies;
      return update.stamp_ns == frame_stamp_ns(i) && answered;
    }));
    if (update.has_map) return true;
    if (stats.replies == 0) std::this_thread::sleep_for(10ms);  // the server is not found yet
  }
  return false;
}

TEST(CApiRunning, RepliesLocateTheClient) {
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

TEST(CApiRunning, ManyThreadsMayPushWhileOneStops) {
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

}  // namespace
