#include "client/src/submap.hpp"

#include <gtest/gtest.h>

#include "client/src/tests/walk.hpp"
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

TEST(OutsideView, IsThinnedEvenly) {
  Cloud map;
  for (int i = 0; i < 1000; ++i) map.points.emplace_back(0, 0.001F * static_cast<float>(i), -1);
  const Cloud extra = outside_view(map, Pose::Identity(), small_view(), 10);
  ASSERT_EQ(extra.size(), 10U);
  EXPECT_FLOAT_EQ(extra.points[1].y(), 0.1F);
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
