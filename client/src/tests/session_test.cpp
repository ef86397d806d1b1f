#include "client/src/session.hpp"

#include <gtest/gtest.h>

#include <condition_variable>
#include <future>
#include <thread>

#include "client/src/tests/walk.hpp"

namespace liloc {
namespace {

using namespace test;
using namespace std::chrono_literals;

template <class Condition>
bool within(std::chrono::milliseconds limit, Condition&& condition) {
  const auto end = std::chrono::steady_clock::now() + limit;
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(1ms);
  }
  return true;
}

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

}  // namespace
}  // namespace liloc
