#include "server/tools/bag_options.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace liloc::toolbox {
namespace {

using testing::HasSubstr;

/// The options of a command line, or what is wrong with it.
Result<bags::ConvertOptions> parse(const std::string& line) {
  CLI::App app;
  BagArguments arguments;
  add_bag_options(app, arguments);
  app.add_option("--device", arguments.devices)->allow_extra_args(false);
  try {
    app.parse(line);
  } catch (const CLI::ParseError& error) {
    return fail("{}", error.what());
  }
  return arguments.options();
}

TEST(BagOptions, TopicsAndFilesAreKnownByTheirIds) {
  const auto options = parse(
      "--lidar ceiling0=/c0/depth --lidar ceiling1=/c1/points --device robot1=/cam/depth --imu robot1=/cam/imu "
      "--truth robot1=truth.tum --device-file robot1=device.json --world odom --still-seconds 2");
  ASSERT_TRUE(options) << options.error().message;
  EXPECT_EQ(options->lidars.size(), 2U);
  EXPECT_EQ(options->lidars.at("ceiling1"), "/c1/points");
  EXPECT_EQ(options->devices.at("robot1"), "/cam/depth");
  EXPECT_EQ(options->imus.at("robot1"), "/cam/imu");
  EXPECT_EQ(options->truths.at("robot1"), "truth.tum");
  EXPECT_EQ(options->device_files.at("robot1"), "device.json");
  EXPECT_EQ(options->world_frame, "odom");
  EXPECT_EQ(options->still_seconds, 2.0);
}

TEST(BagOptions, WithoutAnyTheDefaultsStand) {
  const auto options = parse("");
  ASSERT_TRUE(options);
  EXPECT_EQ(options->world_frame, bags::ConvertOptions{}.world_frame);
  EXPECT_FALSE(BagArguments{}.any());
  BagArguments only_a_device;
  only_a_device.devices = {"robot1=/cam/depth"};
  EXPECT_FALSE(only_a_device.any()) << "it is not of bags alone";
  BagArguments with_a_site;
  with_a_site.site = "site.json";
  EXPECT_TRUE(with_a_site.any());
}

TEST(BagOptions, WhatWouldDoNothingOrIsTwiceIsRefusedByTheFlag) {
  const std::pair<const char*, const char*> cases[] = {
      {"--lidar ceiling0", "--lidar: 'ceiling0' is not ID=VALUE"},
      {"--lidar =topic", "--lidar: '=topic'"},
      {"--imu robot1=", "--imu: 'robot1='"},
      {"--truth a=1 --truth a=2", "--truth: a is given twice"},
      {"--site site.json --world map", "--world"},
      {"--still-seconds 2", "--still-seconds: there is no --device"},
      {"--device robot1=/d --still-seconds 61", "--still-seconds"},
      {"--device robot1=/d --still-seconds nan", "--still-seconds"}};
  for (const auto& [line, says] : cases) {
    const auto options = parse(line);
    ASSERT_FALSE(options) << line;
    EXPECT_THAT(options.error().message, HasSubstr(says));
  }
}

TEST(BagOptions, LeftOutMessagesAreALineATopicWithoutControls) {
  bags::Converted converted;
  converted.left_out["/a"] = {3, "cut off\nforged"};
  converted.left_out["/b"] = {1, "too large"};
  const auto lines = left_out_lines(converted);
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_THAT(lines[0], HasSubstr("/a: 3 messages cannot be used"));
  EXPECT_EQ(lines[0].find('\n'), std::string::npos);
}

}  // namespace
}  // namespace liloc::toolbox
