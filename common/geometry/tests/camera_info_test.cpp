#include "common/geometry/camera_info.hpp"

#include <gmock/gmock.h>

namespace liloc {
namespace {

using testing::HasSubstr;

CameraInfo info_of_sensor() {
  CameraInfo info;
  info.width = 640;
  info.height = 480;
  info.k = {460, 0, 320, 0, 462, 240, 0, 0, 1};
  return info;
}

TEST(CameraInfo, TheRectifiedImageCountsWhereItIsSet) {
  CameraInfo info = info_of_sensor();
  EXPECT_EQ(camera_of(info)->fy, 462);
  info.p = {400, 0, 300, -10, 0, 402, 200, 0, 0, 0, 1, 0};
  info.k[1] = 1;  // of the raw image
  const auto camera = camera_of(info);
  ASSERT_TRUE(camera) << camera.error().message;
  EXPECT_EQ(camera->fy, 402);
  EXPECT_EQ(camera->cx, 300);
  info.k = {};
  EXPECT_TRUE(camera_of(info)) << "the raw image has no intrinsics, this one has";
}

TEST(CameraInfo, ARegionIsCutOutBeforeItsPixelsAreBinned) {
  CameraInfo info = info_of_sensor();
  info.roi = {100, 40, 400, 440};
  info.binning_x = 2;
  info.binning_y = 4;
  const auto camera = camera_of(info);
  ASSERT_TRUE(camera) << camera.error().message;
  EXPECT_EQ(camera->width, 220);
  EXPECT_EQ(camera->height, 100);
  EXPECT_EQ(camera->cx, 110);
  EXPECT_EQ(camera->cy, 50);
  EXPECT_EQ(camera->fx, 230);
  EXPECT_EQ(camera->fy, 115.5);
}

TEST(CameraInfo, WhatCannotBeIsNamed) {
  const auto error_of = [](auto change) {
    CameraInfo info = info_of_sensor();
    change(info);
    const auto camera = camera_of(info);
    return camera ? std::string("taken") : camera.error().message;
  };
  EXPECT_THAT(error_of([](CameraInfo& i) { i.width = 60'000; }), HasSubstr("60000 x 480"));
  EXPECT_THAT(error_of([](CameraInfo& i) { i.k = {}; }), HasSubstr("calibrate"));
  EXPECT_THAT(error_of([](CameraInfo& i) { i.k[1] = 1; }), HasSubstr("k is not"));
  EXPECT_THAT(error_of([](CameraInfo& i) { i.p[0] = 1; }), HasSubstr("p is not"));
  EXPECT_THAT(error_of([](CameraInfo& i) { i.roi = {1, 0, 480, 640}; }), HasSubstr("beyond the image"));
  EXPECT_THAT(error_of([](CameraInfo& i) { i.roi = {0, 0, 0, 640}; }), HasSubstr("beyond the image"));
  EXPECT_THAT(error_of([](CameraInfo& i) { i.binning_y = 1000; }), HasSubstr("binning"));
}

}  // namespace
}  // namespace liloc
