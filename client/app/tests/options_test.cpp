#include "client/app/options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace liloc {
namespace {

using ::testing::HasSubstr;

struct Parsed {
  Result<DaemonOptions> options = fail("not parsed");
  int exit_code = 0;
};

Parsed parse(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), {"liloc-client", "--id", "robot1"});
  Parsed parsed;
  parsed.options = parse_arguments(static_cast<int>(arguments.size()), arguments.data(), parsed.exit_code);
  return parsed;
}

TEST(ClientCommandLine, NamesFollowTheId) {
  const auto parsed = parse({});
  ASSERT_TRUE(parsed.options);
  EXPECT_EQ(parsed.options->topics.depth, "rt/robot1/depth/image_rect_raw");
  EXPECT_EQ(parsed.options->topics.imu, "rt/robot1/imu");
  EXPECT_EQ(parsed.options->ros.names.pose, "rt/robot1/pose");
  EXPECT_EQ(parsed.options->ros.names.odom_frame, "robot1/odom");
  EXPECT_FALSE(parsed.options->topics.use_points);
  EXPECT_EQ(parsed.options->client.local, client::Local::cloud);
}

TEST(ClientCommandLine, AHyphenOfTheIdIsAnUnderscoreInTopics) {
  const char* const arguments[] = {"liloc-client", "--id", "robot-1"};
  int exit_code = 0;
  const auto options = parse_arguments(3, arguments, exit_code);
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_EQ(options->client.id, "robot-1");
  EXPECT_EQ(options->topics.depth, "rt/robot_1/depth/image_rect_raw");
  EXPECT_EQ(options->ros.names.odometry, "rt/robot_1/odom");
}

TEST(ClientCommandLine, NamesCanBeGiven) {
  const auto parsed = parse({"--depth-topic", "/cam/depth", "--map-frame", "world", "--odom-frame", "base_odom",
                             "--diagnostics-topic", "diag", "--tf-ahead-ms", "200", "--tf-max-speed", "0.5"});
  ASSERT_TRUE(parsed.options) << parsed.options.error().message;
  EXPECT_EQ(parsed.options->topics.depth, "rt/cam/depth");
  EXPECT_EQ(parsed.options->ros.names.world_frame, "world");
  EXPECT_EQ(parsed.options->ros.names.odom_frame, "base_odom");
  EXPECT_EQ(parsed.options->ros.names.diagnostics, "rt/diag");
  EXPECT_DOUBLE_EQ(parsed.options->ros.tf_ahead_ms, 200);
}

TEST(ClientCommandLine, AnOdometryTopicLeavesLocalRegistrationToOthers) {
  const auto parsed = parse({"--odometry-topic", "/odom", "--base-translation", "0.1", "0", "0.5",
                             "--base-rotation", "-0.5", "0.5", "-0.5", "0.5"});
  ASSERT_TRUE(parsed.options) << parsed.options.error().message;
  EXPECT_EQ(parsed.options->topics.odometry, "rt/odom");
  EXPECT_EQ(parsed.options->client.local, client::Local::external);
  EXPECT_EQ(parsed.options->ros.names.odom_frame, "odom");
  ASSERT_TRUE(parsed.options->client.T_base_sensor);
  EXPECT_DOUBLE_EQ(parsed.options->client.T_base_sensor->translation_m[2], 0.5);
}

TEST(ClientCommandLine, RequestsHaveABoundInTimeAndInBytes) {
  const auto parsed = parse({"--searching-interval-ms", "350", "--request-bytes", "4000"});
  ASSERT_TRUE(parsed.options) << parsed.options.error().message;
  EXPECT_EQ(parsed.options->client.searching_interval_ms, 350);
  EXPECT_EQ(parsed.options->client.request_bytes, 4000U);
  EXPECT_FALSE(parse({"--request-bytes", "100"}).options);
}

TEST(ClientCommandLine, CloudsTravelAsDracoUnlessToldOtherwise) {
  EXPECT_EQ(parse({}).options->client.codec, client::Codec::draco);
  EXPECT_EQ(parse({"--codec", "voxel"}).options->client.codec, client::Codec::voxel);
  EXPECT_EQ(parse({"--codec", "octree"}).options->client.codec, client::Codec::octree);
  const auto wrong = parse({"--codec", "zip"});
  ASSERT_FALSE(wrong.options);
  EXPECT_NE(wrong.options.error().message.find("--codec"), std::string::npos) << wrong.options.error().message;
}

TEST(ClientCommandLine, APointsTopicHasAVirtualCamera) {
  const auto parsed = parse({"--points-topic", "/points"});
  ASSERT_TRUE(parsed.options) << parsed.options.error().message;
  EXPECT_TRUE(parsed.options->topics.use_points);
  const client::Camera& c = parsed.options->client.camera;
  EXPECT_EQ(c.width, 96);
  EXPECT_NEAR(c.fx, 48, 1e-9);  // 90 degrees across 96 columns
}

TEST(ClientCommandLine, WhatIsWrongIsNamed) {
  const std::pair<std::vector<const char*>, const char*> cases[] = {
      {{"--imu-topic", "a b"}, "topic is"},
      {{"--base-translation", "0", "0", "0"}, "--base-"},
      {{"--imu-translation", "0", "0", "0"}, "--imu-translation"},
      {{"--points-topic", "p", "--points-view", "4", "4", "90", "90"}, "--points-view"},
      {{"--local", "magic"}, "--local"}};
  for (const auto& [arguments, named] : cases) {
    const auto parsed = parse(arguments);
    ASSERT_FALSE(parsed.options) << named;
    EXPECT_EQ(parsed.exit_code, 2);
    EXPECT_THAT(parsed.options.error().message, HasSubstr(named));
  }
}

}  // namespace
}  // namespace liloc
