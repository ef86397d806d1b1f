// What else than depth images an engine takes: the odometry of somebody else, clouds of points.
#include <gtest/gtest.h>

#include "client/engine/tests/walker.hpp"
#include "common/codec/codec.hpp"
#include "common/geometry/depth.hpp"

namespace liloc {
namespace {

using namespace test;

StampNs at(double seconds) {
  return kStart + from_seconds(seconds);
}

/// Frames and wheels into an engine: only the global part is done.
TEST(ExternalOdometryEngine, RequestsCarryTheWheelsPoses) {
  EngineOptions options = engine_options();
  options.local = LocalMethod::external;
  Engine engine(options);
  const auto room = scene::furnished_room(2);
  for (double t = 0; t < 4; t += 0.02) ASSERT_TRUE(engine.add_odometry({at(t), walk(t), std::nullopt}));
  int requests = 0;
  for (int i = 0; i < 40; ++i) {
    const auto frame = engine.add_depth(frame_at(room, i));
    ASSERT_TRUE(frame);
    EXPECT_EQ(frame->source, PoseSource::external);
    EXPECT_LT(distance_m(frame->T_odom_sensor, walk(time_of(i))), 1e-3);
    const auto request = engine.take_request();
    if (!request) continue;
    ++requests;
    EXPECT_LT(distance_m(request->T_odom_sensor, walk(time_of(i))), 1e-3);
    EXPECT_FALSE(request->lpc.bytes.empty());
    EXPECT_EQ(request->local_poses.back().stamp_ns, request->stamp_ns);
  }
  EXPECT_EQ(requests, 4);  // 2.6 s at one in 0.8 s
}

TEST(ExternalOdometryEngine, AFrameWithoutAPoseIsNotSent) {
  EngineOptions options = engine_options();
  options.local = LocalMethod::external;
  Engine engine(options);
  const auto room = scene::furnished_room(2);
  const auto frame = engine.add_depth(frame_at(room, 0));
  ASSERT_TRUE(frame);
  EXPECT_FALSE(frame->informative || frame->converged);
  EXPECT_FALSE(engine.take_request());
}

TEST(ExternalOdometryEngine, IsRefusedWithAnotherMethod) {
  Engine engine(engine_options());
  EXPECT_FALSE(engine.add_odometry({kStart, Pose::Identity(), std::nullopt}));
}

/// The same walk as clouds and as images: the odometry must follow either.
TEST(PointsEngine, AnEngineFollowsClouds) {
  const auto room = scene::furnished_room(1);
  Engine engine(engine_options());
  FrameResult first, now;
  for (int i = 0; i < 60; ++i) {
    const auto cloud = depth_to_cloud(frame_at(room, i), scene::small_camera(), {});
    const auto frame = engine.add_points(stamp_of(i), *cloud);
    ASSERT_TRUE(frame) << frame.error().message;
    now = *frame;
    if (i == 0) first = now;
    EXPECT_TRUE(now.informative && now.converged) << i;
    if (const auto request = engine.take_request()) {
      EXPECT_GT(decode(request->lpc)->size(), 500U);
    }
  }
  const Pose truth = walk(time_of(0)).inverse() * walk(time_of(59));
  EXPECT_LT(distance_m(truth, first.T_odom_sensor.inverse() * now.T_odom_sensor), 0.03);
}

TEST(PointsEngine, AnEmptyCloudIsAFrameThatSaysNothing) {
  Engine engine(engine_options());
  const auto frame = engine.add_points(kStart, Cloud{});
  ASSERT_TRUE(frame);
  EXPECT_FALSE(frame->informative);
  EXPECT_FALSE(engine.take_request());
}

}  // namespace
}  // namespace liloc
