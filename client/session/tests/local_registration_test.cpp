#include "client/session/local_registration.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>

#include "client/engine/tests/walker.hpp"

namespace liloc {
namespace {

using namespace test;
using ::testing::HasSubstr;

SensorFrame depth_at(const scene::BoxRoom& room, int frame) {
  return {frame_at(room, frame), false, {}, SessionClock::Time(std::chrono::nanoseconds(stamp_of(frame)))};
}

class Local : public testing::Test {
 protected:
  [[nodiscard]] auto add(int frame) { return local_.add(depth_at(room_, frame), CloudCodec::draco); }

  const scene::BoxRoom room_ = scene::furnished_room(1);
  EngineOptions options_ = engine_options();
  SampleInbox samples_;
  SessionClock clock_;
  SessionReport report_{"walker"};
  LocalRegistration local_{options_, 1, samples_, clock_, report_};
};

TEST_F(Local, AFrameMakesARequestInTheCodeThatIsAskedForAndItsReplyLocatesTheNext) {
  const auto first = local_.add(depth_at(room_, 0), CloudCodec::voxel);
  ASSERT_TRUE(first);
  ASSERT_TRUE(first->request);
  EXPECT_EQ(first->request->lpc.codec, CloudCodec::voxel);
  EXPECT_FALSE(first->frame.T_map_sensor);
  SpotReply reply;
  reply.seq = first->request->seq;
  reply.stamp_ns = first->request->stamp_ns;
  reply.status = SpotStatus::verified;
  reply.T_map_odom = Pose(Eigen::Translation3d(7, 8, 9));
  local_.add_reply(reply);
  const auto second = add(1);
  ASSERT_TRUE(second);
  ASSERT_TRUE(second->frame.T_map_sensor);
  EXPECT_NEAR(second->frame.T_map_sensor->translation().z(), 9, 0.05);
  EXPECT_EQ(second->tracking, Tracking::tracking);
  EXPECT_EQ(report_.stats().replies_verified, 1U);
  EXPECT_EQ(report_.stats().frames, 2U);
}

TEST_F(Local, WhatTheEngineRefusesIsReportedAndComesToNothing) {
  ASSERT_TRUE(add(1));
  EXPECT_FALSE(add(0));
  EXPECT_EQ(report_.stats().frames_refused, 1U);
  EXPECT_THAT(report_.stats().problem, HasSubstr("not newer"));
}

TEST_F(Local, SamplesBeforeAFrameAreHandedOverAndBadOnesCounted) {
  samples_.add(ImuSample{stamp_of(0), {0, 0, 0}, {0, 0, 9.81}});  // the options have no IMU
  samples_.add(ImuSample{stamp_of(0) + 1, {0, 0, 0}, {0, 0, 9.81}});
  ASSERT_TRUE(add(0));
  EXPECT_EQ(report_.stats().imu_refused, 2U);
}

TEST_F(Local, ADeviceClockThatIsSetIsCountedAndLearnedAnew) {
  const auto add_at = [&](int seconds, double clock_ahead_s) {  // none is left out, however slow the build
    SensorFrame frame = depth_at(room_, 0);
    frame.image.stamp_ns += from_seconds(seconds + clock_ahead_s);
    frame.arrived += std::chrono::seconds(seconds);
    return local_.add(frame, CloudCodec::draco).has_value();
  };
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(add_at(3 * i, 0));
  int taken = 0;
  for (int i = 10; i < 14; ++i) taken += add_at(3 * i, -10) ? 1 : 0;
  EXPECT_EQ(taken, 2) << "the third in a row tells that the clock was set";
  EXPECT_EQ(report_.stats().clock_jumps, 1U);
}

TEST_F(Local, BeyondItsShareOfACoreFramesAreLeftOut) {
  LocalRegistration slow(options_, 1e-6, samples_, clock_, report_);
  int taken = 0;
  for (int i = 0; i < 20; ++i) taken += slow.add(depth_at(room_, i), CloudCodec::draco) ? 1 : 0;
  EXPECT_EQ(taken, 5) << "so many tell what a frame costs";
  EXPECT_EQ(report_.stats().frames_skipped, 15U);
}

TEST_F(Local, AFoundServerIsAskedWithTheNextFrame) {
  ASSERT_TRUE(add(0)->request);
  ASSERT_FALSE(add(4)->request);
  local_.server_found();
  EXPECT_TRUE(add(5)->request);
}

TEST_F(Local, TheTraceHasEachFrameAndTroubleWithItIsAnError) {
  const auto folder =
      std::filesystem::temp_directory_path() / ("liloc_local_registration_" + std::to_string(getpid()));
  EXPECT_TRUE(local_.close_trace()) << "there is none";
  ASSERT_TRUE(local_.open_trace(folder));
  for (int i = 0; i < 3; ++i) ASSERT_TRUE(add(i));
  ASSERT_TRUE(local_.close_trace());
  std::ifstream local(folder / "local.csv"), spots(folder / "spots.csv");
  const auto rows = [](std::istream& in) {
    return std::count(std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>(), '\n');
  };
  EXPECT_EQ(rows(local), 4) << "a header, and a row a frame";
  EXPECT_EQ(rows(spots), 2) << "a header, and the request that nobody answered";
  std::ofstream(folder / "a-file") << "";
  EXPECT_FALSE(local_.open_trace(folder / "a-file" / "x"));
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace liloc
