#include "common/geometry/camera.hpp"

#include <gmock/gmock.h>

namespace liloc {
namespace {

const Camera kCamera{64, 48, 50.0, 52.0, 31.5, 23.5, 0.001};

TEST(Camera, ZeroIntrinsicsAreNamed) {
  Camera camera = kCamera;
  camera.fx = 0;
  EXPECT_THAT(camera.validated("site.json: ceiling0").error().message, testing::HasSubstr("ceiling0.fx is 0"));
  camera = kCamera;
  camera.depth_scale_m = NAN;
  EXPECT_FALSE(camera.validated("x"));
  EXPECT_TRUE(kCamera.validated("x"));
}

TEST(Camera, AnglesOfViewAndScalesThatNoSensorHasAreNamed) {
  const auto error_with = [](double fx, double fy, double scale_m) {
    Camera camera = kCamera;
    camera.fx = fx;
    camera.fy = fy;
    camera.depth_scale_m = scale_m;
    const auto valid = camera.validated("x");
    return valid ? std::string("none") : valid.error().message;
  };
  EXPECT_THAT(error_with(0.5, 52, 0.001), testing::HasSubstr("x.fx is 0.5: 64 pixels would see 178 deg"));
  EXPECT_THAT(error_with(50, 1e12, 0.001), testing::HasSubstr("x.fy is 1000000000000"));
  EXPECT_THAT(error_with(50, NAN, 0.001), testing::HasSubstr("x.fy is nan"));
  EXPECT_THAT(error_with(50, 52, 1), testing::HasSubstr("x.depth_scale is 1"));
  EXPECT_THAT(error_with(50, 52, 1e-6), testing::HasSubstr("x.depth_scale is 1e-06"));
  EXPECT_EQ(error_with(50, 52, 0.00025), "none");
  EXPECT_TRUE((Camera{1024, 16, 512, 800, 512, 8, 0.001}.validated("few rows")));
}

TEST(Camera, AShrunkCameraSeesTheSameRays) {
  const Camera small = shrunk(kCamera, 4);
  EXPECT_EQ(small.width, 16);
  // The centre of small pixel u covers big pixels 4u..4u+3, whose mean is 4u + 1.5.
  EXPECT_NEAR((5 - small.cx) / small.fx, (21.5 - kCamera.cx) / kCamera.fx, 1e-12);
}

TEST(Camera, SizesAndCentresFarFromTheImageAreNamed) {
  const auto error_of = [](const Camera& camera) {
    const auto valid = camera.validated("x");
    return valid ? std::string("none") : valid.error().message;
  };
  Camera camera = kCamera;
  camera.width = 0;
  EXPECT_THAT(error_of(camera), testing::HasSubstr("x.width is 0; must be 1..8192"));
  camera = kCamera;
  camera.height = 8193;
  EXPECT_THAT(error_of(camera), testing::HasSubstr("x.height is 8193"));
  camera = kCamera;
  camera.cx = -65;
  EXPECT_THAT(error_of(camera), testing::HasSubstr("x.cx is -65; must lie near the image of width 64"));
  camera.cx = -64;
  EXPECT_EQ(error_of(camera), "none") << "a part of a larger image";
  camera.cy = NAN;
  EXPECT_THAT(error_of(camera), testing::HasSubstr("x.cy is nan"));
}

TEST(Camera, IsAReturnWhateverIsNeitherNothingNorTheLargestValue) {
  EXPECT_FALSE(is_return(0) || is_return(65535));
  EXPECT_TRUE(is_return(1) && is_return(65534));
}

}  // namespace
}  // namespace liloc
