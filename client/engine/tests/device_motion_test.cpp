#include "client/engine/device_motion.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/engine/tests/walker.hpp"
#include "common/geometry/depth.hpp"

namespace liloc {
namespace {

using namespace test;
using ::testing::HasSubstr;

Result<Placed> place(DeviceMotion& motion, const DepthImage& image, FrameFault fault = FrameFault::none) {
  FrameSpread spread;
  spread.fault = fault;
  return motion.place({image, nullptr}, spread);
}

TEST(DepthFrame, ShowsItsPointsOrWhatTheImageMeasured) {
  const EngineOptions options = engine_options();
  const DepthImage image = frame_at(scene::furnished_room(1), 0);
  EXPECT_EQ(DepthFrame{image}.cloud(options.camera, options)->size(),
            depth_to_cloud(image, options.camera, {options.min_range_m, options.max_range_m})->size());
  Cloud points;
  points.points.emplace_back(1, 2, 3);
  const DepthFrame of_points{image, &points};
  EXPECT_EQ(of_points.cloud(options.camera, options)->size(), 1U);
}

TEST(DeviceMotion, OfItsOwnOdometryFollowsTheWalkAndSeesWhatIsAround) {
  DeviceMotion motion(engine_options());
  const auto room = scene::furnished_room(1);
  Pose T_odom_first = Pose::Identity(), T_odom_now = Pose::Identity();
  for (int i = 0; i < 45; ++i) {
    const auto placed = place(motion, frame_at(room, i));
    ASSERT_TRUE(placed);
    EXPECT_TRUE(placed->informative) << i;
    EXPECT_FALSE(placed->misfit) << i;
    (i == 0 ? T_odom_first : T_odom_now) = placed->step.T_odom_sensor;
  }
  EXPECT_TRUE(motion.placed());
  EXPECT_LT(distance_m(walk(time_of(0)).inverse() * walk(time_of(44)), T_odom_first.inverse() * T_odom_now),
            0.03);
  EXPECT_GT(motion.surroundings().size(), 0U);
  EXPECT_EQ(motion.problem(), "");
}

TEST(DeviceMotion, ACoveredLensSaysNothingAndIsNoMisfit) {
  DeviceMotion motion(engine_options());
  const auto room = scene::furnished_room(1);
  for (int i = 0; i < 15; ++i) ASSERT_TRUE(place(motion, frame_at(room, i)));
  const auto covered = place(motion, covered_at(15), FrameFault::covered);
  ASSERT_TRUE(covered);
  EXPECT_FALSE(covered->informative);
  EXPECT_FALSE(covered->misfit);
  EXPECT_EQ(covered->step.source, PoseSource::guess);
}

TEST(DeviceMotion, AClockThatIsSetStartsASegment) {
  DeviceMotion motion(engine_options());
  const auto room = scene::furnished_room(1);
  for (int i = 0; i < 5; ++i) EXPECT_EQ(place(motion, frame_at(room, i))->step.segment, 0U);
  motion.clock_set(-from_seconds(10));
  DepthImage image = frame_at(room, 5);
  image.stamp_ns -= from_seconds(10);
  EXPECT_EQ(place(motion, image)->step.segment, 1U);
}

TEST(DeviceMotion, OfSomebodyElsesOdometryNeedsSamples) {
  EngineOptions options = engine_options();
  options.local = LocalMethod::external;
  DeviceMotion motion(options);
  const auto room = scene::furnished_room(1);
  const auto before = place(motion, frame_at(room, 0));
  EXPECT_FALSE(before->informative);
  EXPECT_FALSE(motion.placed());
  EXPECT_THAT(motion.problem(), HasSubstr("no odometry for the newest frame"));
  for (const int i : {1, 2})
    ASSERT_TRUE(motion.add(OdometrySample{stamp_of(i), walk(time_of(i)), std::nullopt}));
  const auto after = place(motion, frame_at(room, 2));
  EXPECT_TRUE(after->informative);
  EXPECT_EQ(after->step.source, PoseSource::external);
  EXPECT_TRUE(motion.placed());
  EXPECT_EQ(motion.problem(), "");
}

TEST(DeviceMotion, SamplesOfASourceThatItDoesNotHaveAreRefused) {
  DeviceMotion motion(engine_options());
  EXPECT_FALSE(motion.add(ImuSample{kStart, {0, 0, 0}, {0, 0, 9.81}}));
  EXPECT_FALSE(motion.add(OdometrySample{kStart, Pose::Identity(), std::nullopt}));
  EXPECT_EQ(motion.imu(), nullptr);
  EXPECT_FALSE(motion.judge_imu(kStart, {}, true));
  EngineOptions options = engine_options();
  options.T_imu_sensor = mounting();
  DeviceMotion with_imu(options);
  EXPECT_TRUE(with_imu.add(ImuSample{kStart, {0, 0, 0}, {0, 0, 9.81}}));
  EXPECT_NE(with_imu.imu(), nullptr);
}

}  // namespace
}  // namespace liloc
