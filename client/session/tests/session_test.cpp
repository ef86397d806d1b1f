#include "client/session/session.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <condition_variable>
#include <future>
#include <mutex>
#include <thread>

#include "client/engine/tests/walker.hpp"
#include "common/base/log.hpp"
#include "common/testing/within.hpp"

namespace liloc {
namespace {

using namespace test;
using namespace std::chrono_literals;

SessionOptions options(std::size_t queue = 100) {
  SessionOptions o;
  o.engine = engine_options();
  o.queue_frames = queue;
  return o;
}

/// So far apart that none is left out for want of computing time, however slow the build.
DepthImage unhurried(const scene::BoxRoom& room, int frame) {
  DepthImage image = frame_at(room, 0);
  image.stamp_ns += from_ms(3000.0 * frame);
  return image;
}

TEST(Session, ASlowServerDoesNotDelayFrames) {
  std::promise<void> release;
  const auto released = release.get_future().share();
  SessionCallbacks callbacks;
  callbacks.send = [released](const SpotRequest&) {
    released.wait();
    return Status{};
  };
  auto session = Session::create(options(), callbacks);
  ASSERT_TRUE(session);
  const auto room = scene::furnished_room(1);
  for (int i = 0; i < 40; ++i) ASSERT_TRUE((*session)->push_depth(unhurried(room, i)));
  EXPECT_TRUE(
      within(20s, [&] { return (*session)->stats().frames == 40; }));  // three requests wait or were displaced
  release.set_value();
  ASSERT_TRUE((*session)->stop());
  EXPECT_EQ((*session)->stats().frames_dropped, 0U);
  EXPECT_GE((*session)->stats().requests, 3U);
}

TEST(Session, AFullQueueDropsTheOldestAndCounts) {
  std::promise<void> release;
  const auto released = release.get_future().share();
  std::vector<StampNs> seen;
  SessionCallbacks callbacks;
  callbacks.on_frame = [&, released](const FrameResult& frame, Tracking) {
    released.wait();
    seen.push_back(frame.stamp_ns);
  };
  auto session = Session::create(options(2), callbacks);
  ASSERT_TRUE(session);
  const auto room = scene::furnished_room(1);
  ASSERT_TRUE((*session)->push_depth(frame_at(room, 0)));
  ASSERT_TRUE(within(10s, [&] { return (*session)->stats().frames == 1; }));  // it hangs in the callback
  for (int i = 1; i < 10; ++i) ASSERT_TRUE((*session)->push_depth(frame_at(room, i)));
  release.set_value();
  ASSERT_TRUE((*session)->stop());
  EXPECT_EQ((*session)->stats().frames_dropped, 7U);
  EXPECT_EQ(seen, (std::vector<StampNs>{stamp_of(0), stamp_of(8), stamp_of(9)}));
}

TEST(Session, RepliesLocateTheNextFrame) {
  Session* self = nullptr;
  std::promise<void> ready;
  const auto is_ready = ready.get_future().share();
  SessionCallbacks callbacks;
  callbacks.send = [&, is_ready](const SpotRequest& request) {
    is_ready.wait();
    SpotReply reply;
    reply.seq = request.seq;
    reply.stamp_ns = request.stamp_ns;
    reply.status = SpotStatus::verified;
    reply.T_map_odom = Pose(Eigen::Translation3d(7, 8, 9));
    self->add_reply(reply);
    return Status{};
  };
  auto session = Session::create(options(), callbacks);
  ASSERT_TRUE(session);
  self = session->get();
  ready.set_value();
  const auto room = scene::furnished_room(1);
  ASSERT_TRUE((*session)->push_depth(frame_at(room, 0)));
  ASSERT_TRUE(within(10s, [&] { return (*session)->stats().replies_verified == 1; }));
  ASSERT_TRUE((*session)->push_depth(frame_at(room, 1)));
  ASSERT_TRUE(within(10s, [&] { return (*session)->stats().frames == 2; }));
  const auto frame = (*session)->newest_frame();
  ASSERT_TRUE(frame->T_map_sensor);
  EXPECT_NEAR(frame->T_map_sensor->translation().y(), 8, 0.05);
  EXPECT_NEAR((*session)->stats().localized_s,
              to_seconds(frame_at(room, 1).stamp_ns - frame_at(room, 0).stamp_ns), 1e-9);
  EXPECT_EQ((*session)->tracking(), Tracking::tracking);
}

TEST(Session, StopFinishesWhatWaitsAndTakesNothingMore) {
  auto session = Session::create(options(), {});
  ASSERT_TRUE(session);
  const auto room = scene::furnished_room(1);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE((*session)->push_depth(unhurried(room, i)));
  ASSERT_TRUE((*session)->stop());
  EXPECT_EQ((*session)->stats().frames, 20U);
  EXPECT_EQ((*session)->stats().requests_unsent, (*session)->stats().requests);  // there is no transport
  EXPECT_FALSE((*session)->push_depth(frame_at(room, 20)));
  EXPECT_TRUE((*session)->stop());
}

TEST(Session, AnOldFrameIsCountedAndHarmless) {
  auto session = Session::create(options(), {});
  ASSERT_TRUE(session);
  const auto room = scene::furnished_room(1);
  for (const int i : {0, 1, 1, 0, 2}) ASSERT_TRUE((*session)->push_depth(frame_at(room, i)));
  ASSERT_TRUE((*session)->stop());
  EXPECT_EQ((*session)->stats().frames, 3U);
  EXPECT_EQ((*session)->stats().frames_refused, 2U);
}

/// A session whose server answers at once: "odometry lies at (7, 8, 9)".
class Answered {
 public:
  explicit Answered(SessionOptions o) {
    SessionCallbacks callbacks;
    callbacks.send = [this](const SpotRequest& request) {
      SpotReply reply;
      reply.seq = request.seq;
      reply.stamp_ns = request.stamp_ns;
      reply.odom_segment = request.odom_segment;
      reply.status = SpotStatus::verified;
      reply.T_map_odom = Pose(Eigen::Translation3d(7, 8, 9));
      reply.covariance = 1e-6 * Matrix6d::Identity();
      session->add_reply(reply);
      ++answered;
      return Status{};
    };
    session = std::move(*Session::create(std::move(o), std::move(callbacks)));
  }
  ~Answered() { static_cast<void>(session->stop()); }
  Answered(const Answered&) = delete;
  Answered& operator=(const Answered&) = delete;
  /// Frames of the walk, their stamps off by so much; each is waited for.
  void walk_on(int frames, StampNs off_ns = 0) {
    for (const int end = frame + frames; frame < end; ++frame) {
      DepthImage image = frame_at(room, frame);
      image.stamp_ns += off_ns;
      const auto seen = [&] {
        const SessionStats s = session->stats();
        return s.frames + s.frames_refused + s.frames_skipped;
      };
      const auto before = seen();
      static_cast<void>(session->push_depth(std::move(image)));
      EXPECT_TRUE(within(20s, [&] { return seen() > before; }));
    }
  }
  [[nodiscard]] bool tracks() const {
    return within(5s, [&] { return session->tracking() == Tracking::tracking; });
  }

  scene::BoxRoom room = scene::furnished_room(1);
  std::unique_ptr<Session> session;
  std::atomic<int> answered = 0;
  int frame = 0;
};

TEST(SessionStamps, AClockSetBackIsToldAndTheDeviceLocatedAgain) {
  Answered device(options());
  device.walk_on(1);
  ASSERT_TRUE(within(20s, [&] { return device.answered > 0; }));
  device.walk_on(20);
  ASSERT_TRUE(device.tracks());
  const int asked = device.answered;
  device.walk_on(6, -from_seconds(10));
  EXPECT_THAT(device.session->stats().problem, testing::HasSubstr("clock was set back by 10.0 s"));
  ASSERT_TRUE(within(20s, [&] { return device.answered > asked; }));
  device.walk_on(1, -from_seconds(10));
  EXPECT_EQ(device.session->tracking(), Tracking::tracking);
  const SessionStats stats = device.session->stats();
  EXPECT_EQ(stats.frames_refused, 2U);
  EXPECT_EQ(stats.clock_jumps, 1U);
  EXPECT_GT(stats.localized_s, 0);
  EXPECT_LT(stats.localized_s, 2.5);
}

TEST(SessionStamps, RefusedFramesAreNoTracking) {
  Answered device(options());
  device.walk_on(1);
  ASSERT_TRUE(within(20s, [&] { return device.answered > 0; }));
  device.walk_on(5);
  ASSERT_TRUE(device.tracks());
  std::vector<std::string> lines;
  log::set_sink([&](log::Level, std::string_view line) { lines.emplace_back(line); });
  for (int i = 0; i < 20; ++i) {
    --device.frame;
    device.walk_on(1);  // the same stamp again and again
  }
  EXPECT_EQ(device.session->tracking(), Tracking::lost);
  EXPECT_THAT(device.session->stats().problem, testing::HasSubstr("not newer"));
  EXPECT_EQ(lines.size(), 1U);
  log::set_sink({});
  device.walk_on(1);
  EXPECT_EQ(device.session->tracking(), Tracking::tracking);
  EXPECT_EQ(device.session->stats().problem, "");
}

TEST(SessionStamps, OneFarAheadIsDroppedAndSpoilsNothing) {
  Answered device(options());
  device.walk_on(10);
  device.walk_on(1, from_seconds(3600));
  device.walk_on(10);
  const SessionStats stats = device.session->stats();
  EXPECT_EQ(stats.frames_refused, 1U);
  EXPECT_EQ(stats.clock_jumps, 0U);
  EXPECT_EQ(stats.frames, 20U);
  EXPECT_EQ(device.session->newest_frame()->odom_segment, 0U);
}

TEST(SessionStamps, OtherUnitsAndNoStampAreRefusedAtOnce) {
  SessionOptions o = options();
  o.engine.T_imu_sensor = mounting();
  Answered device(o);
  const StampNs now_ns = std::chrono::system_clock::now().time_since_epoch() / 1ns;
  const struct {
    StampNs stamp_ns;
    const char* says;
  } wrong[] = {
      {now_ns / 1'000, "microseconds"}, {now_ns / 1'000'000, "milliseconds"}, {0, "not set"}, {-7, "not set"}};
  for (const auto& w : wrong) {
    DepthImage image = frame_at(device.room, 0);
    image.stamp_ns = w.stamp_ns;
    for (const Status& status : {device.session->push_depth(image), device.session->push_points(w.stamp_ns, {}),
                                 device.session->push_imu({w.stamp_ns, {0, 0, 0}, {0, 0, 9.81}})}) {
      ASSERT_FALSE(status);
      EXPECT_THAT(status.error().message, testing::HasSubstr(w.says));
    }
    EXPECT_THAT(device.session->stats().problem, testing::HasSubstr(w.says));
  }
  EXPECT_EQ(device.session->stats().frames_refused, 8U);
  EXPECT_EQ(device.session->stats().imu_refused, 4U);
}

TEST(SessionSamples, NotANumberFromTheImuIsRefusedAtOnce) {
  SessionOptions o = options();
  o.engine.T_imu_sensor = mounting();
  Answered device(o);
  EXPECT_FALSE(device.session->push_imu({kStart, {NAN, 0, 0}, {0, 0, 9.81}}));
  EXPECT_FALSE(device.session->push_imu({kStart, {0, 0, 0}, {0, INFINITY, 9.81}}));
  EXPECT_EQ(device.session->stats().imu_refused, 2U);
  EXPECT_TRUE(device.session->push_imu({kStart, {0, 0, 0}, {0, 0, 9.81}}));
}

TEST(SessionReplies, WhatNobodyAskedForChangesNothing) {
  Answered device(options());
  device.walk_on(1);
  ASSERT_TRUE(within(20s, [&] { return device.answered > 0; }));
  SpotReply forged;
  forged.server_id = "forger";
  forged.seq = 1'000'000;  // far ahead: the server itself would be a straggler from then on
  forged.stamp_ns = stamp_of(3);
  forged.status = SpotStatus::verified;
  forged.T_map_odom = Pose(Eigen::Translation3d(70, 8, 9));
  forged.covariance = 1e-6 * Matrix6d::Identity();
  EXPECT_FALSE(device.session->add_reply(forged));
  forged.seq = 1;  // asked for, but of another frame
  EXPECT_FALSE(device.session->add_reply(forged));
  const int before = device.answered;
  device.walk_on(20);
  ASSERT_TRUE(within(20s, [&] { return device.answered > before; }));
  device.walk_on(1);
  const SessionStats stats = device.session->stats();
  EXPECT_EQ(stats.replies_strange, 2U);
  EXPECT_EQ(stats.replies, static_cast<std::uint64_t>(device.answered)) << "the server was left";
  ASSERT_TRUE(device.session->newest_frame()->T_map_sensor);
  EXPECT_NEAR(device.session->newest_frame()->T_map_sensor->translation().x(), 7, 1);
}

/// A device that asks two servers, of which the first ends.
TEST(SessionReplies, WhatTheStandbyVerifiedCountsOnceTheFollowedServerIsLate) {
  std::mutex mutex;
  std::vector<SpotRequest> asked;
  SessionCallbacks callbacks;
  callbacks.send = [&](const SpotRequest& request) {
    const std::scoped_lock lock(mutex);
    asked.push_back(request);
    return Status{};
  };
  auto session = Session::create(options(), callbacks);
  ASSERT_TRUE(session);
  const auto room = scene::furnished_room(1);
  int frame = 0;
  const auto next_request = [&](std::size_t count) {
    return within(20s, [&] {
      EXPECT_TRUE((*session)->push_depth(frame_at(room, frame++)));
      std::this_thread::sleep_for(5ms);
      const std::scoped_lock lock(mutex);
      return asked.size() >= count;
    });
  };
  const auto reply = [&](std::size_t index, const char* server) {
    const std::scoped_lock lock(mutex);
    SpotReply r;
    r.server_id = server;
    r.seq = asked[index].seq;
    r.stamp_ns = asked[index].stamp_ns;
    r.odom_segment = asked[index].odom_segment;
    r.status = SpotStatus::verified;
    r.T_map_odom = Pose(Eigen::Translation3d(7, 8, 9));
    return r;
  };
  ASSERT_TRUE(next_request(1));
  EXPECT_TRUE(within(20s, [&] { return (*session)->unanswered(); }));
  EXPECT_TRUE((*session)->add_reply(reply(0, "edge1")));
  EXPECT_FALSE((*session)->unanswered());
  ASSERT_TRUE(next_request(2));
  EXPECT_FALSE((*session)->add_reply(reply(1, "edge2")));
  std::optional<SpotReply> overdue;
  ASSERT_TRUE(within(20s, [&] { return (overdue = (*session)->add_overdue_reply()).has_value(); }));
  EXPECT_EQ(overdue->server_id, "edge2");
  EXPECT_EQ((*session)->stats().replies_verified, 2U);
  EXPECT_FALSE((*session)->add_overdue_reply());
}

TEST(SessionReplies, AServerThatIsFoundIsAskedAtOnce) {
  std::atomic<int> asked = 0;
  SessionCallbacks callbacks;
  callbacks.send = [&](const SpotRequest&) {
    ++asked;
    return Status{};
  };
  SessionOptions o = options();
  o.engine.interval_ns = from_ms(60'000);
  o.engine.searching_interval_ns = from_ms(1);
  auto session = Session::create(o, callbacks);
  ASSERT_TRUE(session);
  const auto room = scene::furnished_room(1);
  ASSERT_TRUE((*session)->push_depth(frame_at(room, 0)));
  ASSERT_TRUE(within(20s, [&] { return asked == 1; }));
  ASSERT_TRUE((*session)->push_depth(frame_at(room, 1)));
  ASSERT_TRUE(within(20s, [&] { return (*session)->stats().frames == 2; }));
  EXPECT_EQ(asked, 1);
  (*session)->server_found();
  ASSERT_TRUE((*session)->push_depth(frame_at(room, 2)));
  EXPECT_TRUE(within(20s, [&] { return asked == 2; }));
}

TEST(SessionReplies, AnotherDeviceOfTheSameIdIsToldWhileItAsks) {
  Answered device(options());
  device.walk_on(2);
  EXPECT_EQ(device.session->stats().problem, "");
  device.session->namesake_heard();
  EXPECT_THAT(device.session->stats().problem, testing::HasSubstr("another device asks as"));
}

}  // namespace
}  // namespace liloc
