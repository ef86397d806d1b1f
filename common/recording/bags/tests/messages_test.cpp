// Messages as drivers write them, and as they ought not to.
#include <gmock/gmock.h>

#include "common/recording/bags/ros_messages.hpp"
#include "common/recording/bags/tests/written.hpp"

namespace liloc::bags {
namespace {

using testing::HasSubstr;
constexpr std::array<double, 9> kK{460, 0, 320, 0, 462, 240, 0, 0, 1};
constexpr std::array<double, 12> kP{400, 0, 300, -10, 0, 402, 200, 0, 0, 0, 1, 0};

TEST(CameraInfoMessage, RectifiedIntrinsicsRegionAndBinningCountAsTheyDoLive) {
  EXPECT_EQ(camera_info(written::camera_info(640, 480, kK))->value.fy, 462);
  const auto part = camera_info(written::camera_info(640, 480, kK, kP, 2, {100, 40, 400, 440}));
  ASSERT_TRUE(part) << part.error().message;
  EXPECT_EQ(part->value.width, 220);
  EXPECT_EQ(part->value.height, 200);
  EXPECT_EQ(part->value.fx, 200);
  EXPECT_EQ(part->value.cx, 100);
  EXPECT_EQ(part->value.cy, 80);
}

TEST(CameraInfoMessage, WhatCannotBeIsNamed) {
  EXPECT_THAT(camera_info(written::camera_info(640, 480, {})).error().message, HasSubstr("calibrate"));
  EXPECT_THAT(camera_info(written::camera_info(640, 480, kK, {}, 0, {1, 0, 480, 640})).error().message,
              HasSubstr("roi"));
  const std::string whole = written::camera_info(640, 480, kK);
  EXPECT_THAT(camera_info(whole.substr(0, whole.size() - 40)).error().message, HasSubstr("cut short"));
}

}  // namespace
}  // namespace liloc::bags
