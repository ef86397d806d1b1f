#include "client/engine/submap.hpp"

#include <gtest/gtest.h>

#include "client/engine/tests/walker.hpp"
#include "common/codec/codec.hpp"

namespace liloc {
namespace {

using namespace test;

SensorView small_view() {
  return {scene::small_camera(), 0.25, 8.5};
}

TEST(OutsideView, KeepsWhatLiesAsideAndBehindWithinRange) {
  const Cloud map{{{0, 0, 2}, {0, 0, -2}, {5, 0, 1}, {0, 0, -20}}, {}};
  const Cloud extra = outside_view(map, Pose::Identity(), small_view(), 100);
  ASSERT_EQ(extra.size(), 2U);
  EXPECT_FLOAT_EQ(extra.points[0].z(), -2);
  EXPECT_FLOAT_EQ(extra.points[1].x(), 5);
}

TEST(OutsideView, IsInTheSensorsFrame) {
  const Pose T = walk(3);
  const Eigen::Vector3d behind(0.5, 0.2, -1.5);
  const Cloud map{{(T * behind).cast<float>()}, {}};
  const Cloud extra = outside_view(map, T, small_view(), 100);
  ASSERT_EQ(extra.size(), 1U);
  EXPECT_LT((extra.points[0].cast<double>() - behind).norm(), 1e-5);
}

TEST(OutsideView, LeavesOutSurfacesWhoseOtherSideIsNearer) {
  const Eigen::Vector3f left(-1, 0, 0), behind_it(-1.1F, 0, 0);  // two sides of a partition
  const Cloud map{{left, behind_it}, {Eigen::Vector3f::UnitX(), -Eigen::Vector3f::UnitX()}};
  const Cloud before = outside_view(map, Pose::Identity(), small_view(), 100);
  ASSERT_EQ(before.size(), 1U);
  EXPECT_FLOAT_EQ(before.points[0].x(), left.x());
  Pose T_beyond = Pose::Identity();
  T_beyond.translation() = Eigen::Vector3d(-3, 0, 0);
  const Cloud beyond = outside_view(map, T_beyond, small_view(), 100);
  ASSERT_EQ(beyond.size(), 1U);
  EXPECT_FLOAT_EQ(beyond.points[0].x(), behind_it.x() + 3);
}

TEST(OutsideView, IsThinnedEvenly) {
  Cloud map;
  for (int i = 0; i < 1000; ++i) map.points.emplace_back(0, 0.001F * static_cast<float>(i), -1);
  const Cloud extra = outside_view(map, Pose::Identity(), small_view(), 10);
  ASSERT_EQ(extra.size(), 10U);
  EXPECT_FLOAT_EQ(extra.points[1].y(), 0.1F);
}

/// What all requests of a walk take, and the newest.
struct Sent {
  std::size_t most_bytes = 0, requests = 0;
  SpotRequest last;
};

Sent walk_within(std::size_t request_bytes) {
  EngineOptions options = engine_options();
  options.request_bytes = request_bytes;
  Engine engine(options);
  const auto room = scene::furnished_room(1);
  Sent sent;
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(engine.add_depth(frame_at(room, i)));
    auto request = engine.take_request();
    if (!request) continue;
    ++sent.requests;
    sent.most_bytes = std::max(sent.most_bytes, request->lpc.bytes.size() + request->extra.bytes.size());
    sent.last = std::move(*request);
  }
  return sent;
}

TEST(Submap, RequestsKeepTheirByteBudgetAndTheSurroundingsGiveWayFirst) {
  const Sent free = walk_within(60'000);
  const std::size_t frame = free.last.lpc.bytes.size(), extra = free.last.extra.bytes.size();
  ASSERT_GT(extra, 500U);
  for (const std::size_t budget : {2000UL, frame, frame + extra / 2, frame + extra}) {
    const Sent sent = walk_within(budget);
    EXPECT_EQ(sent.requests, free.requests);
    EXPECT_LE(sent.most_bytes, budget);
    EXPECT_LE(sent.last.lpc.bytes.size(), frame);
    if (budget < frame) continue;
    EXPECT_EQ(sent.last.lpc.bytes, free.last.lpc.bytes) << budget;
    EXPECT_EQ(sent.last.extra.bytes.empty(), budget == frame);
  }
}

/// A walk about the room: later requests carry walls that the frame does not show, where they are.
TEST(Submap, HoldsTheRoomAroundTheFrame) {
  EngineOptions options = engine_options();
  Engine engine(options);
  const auto room = scene::furnished_room(1);
  std::optional<SpotRequest> last;
  for (int i = 0; i < 100; ++i) {
    ASSERT_TRUE(engine.add_depth(frame_at(room, i)));
    if (auto request = engine.take_request()) last = std::move(request);
  }
  ASSERT_TRUE(last);
  const auto extra = decode(last->extra);
  ASSERT_TRUE(extra) << extra.error().message;
  EXPECT_GT(extra->size(), 200U);
  EXPECT_LT(last->extra.bytes.size(), 8'000U);
  const Pose T_map_sensor = walk(to_seconds(last->stamp_ns - kStart));
  int on_surface = 0;
  for (const auto& p : extra->points) {  // a wall, floor, ceiling, or a face of the furniture
    const Eigen::Vector3d q = T_map_sensor * p.cast<double>();
    const auto near_face = [&](const scene::Box& box) {
      const bool inside = ((q - box.low).array() > -0.06).all() && ((box.high - q).array() > -0.06).all();
      const double to_face =
          std::min((q - box.low).cwiseAbs().minCoeff(), (box.high - q).cwiseAbs().minCoeff());
      return inside && to_face < 0.06;
    };
    bool near = near_face(room.walls);
    for (const auto& box : room.furniture) near = near || near_face(box);
    on_surface += near;
  }
  EXPECT_GT(on_surface, 0.95 * static_cast<double>(extra->size()));
}

TEST(Submap, IsNotSentWhereItIsNotWanted) {
  for (const bool cold : {false, true}) {
    EngineOptions options = engine_options();
    options.submap = cold;  // off, or on but cold
    options.cold = cold;
    Engine engine(options);
    const auto room = scene::furnished_room(1);
    for (int i = 0; i < 60; ++i) {
      ASSERT_TRUE(engine.add_depth(frame_at(room, i)));
      if (const auto request = engine.take_request()) {
        EXPECT_TRUE(request->extra.bytes.empty());
      }
    }
  }
}

}  // namespace
}  // namespace liloc
