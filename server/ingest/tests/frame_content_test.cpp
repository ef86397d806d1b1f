#include "server/ingest/frame_content.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace liloc {
namespace {

constexpr Camera kCamera{40, 30, 40, 40, 20, 15, 0.001};

/// Looks straight down from 3 m.
const Pose kOverhead = [] {
  Pose T_map_sensor = Pose::Identity();
  T_map_sensor.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  T_map_sensor.translation().z() = 3;
  return T_map_sensor;
}();

/// So many pixels at each depth, in units; the others have no return.
DepthImage image_of(const Camera& camera, const std::vector<std::pair<std::uint16_t, std::size_t>>& depths) {
  DepthImage image{1, camera.width, camera.height, {}};
  for (const auto& [units, count] : depths) image.units.insert(image.units.end(), count, units);
  image.units.resize(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height), 0);
  return image;
}

TEST(FrameContent, TellsReturnsWhatIsUsableAndRanges) {
  const FrameContent content =
      content_of(image_of(kCamera, {{2000, 600}, {3000, 200}, {100, 100}}), kCamera, kOverhead);
  EXPECT_DOUBLE_EQ(content.returns, 900.0 / 1200);
  EXPECT_DOUBLE_EQ(content.usable, 800.0 / 900) << "10 cm is nearer than registration uses";
  EXPECT_NEAR(content.range_m, 2, 1e-6);
  EXPECT_NEAR(content.far_m, 3, 1e-6);
}

TEST(FrameContent, TellsHowFarBelowTheFloorLies) {
  EXPECT_NEAR(content_of(image_of(kCamera, {{2000, 200}, {3000, 1000}}), kCamera, kOverhead).drop_m, 3, 1e-6);
  Pose T_map_sensor = kOverhead;  // from a corner: the depth of a plane changes, how far below it lies does not
  T_map_sensor.linear() = T_map_sensor.linear() * Eigen::AngleAxisd(0.6, Eigen::Vector3d::UnitX());
  const Eigen::Vector3d down = -T_map_sensor.linear().row(2).transpose();
  DepthImage image = image_of(kCamera, {});
  Cloud cloud;
  for (int v = 0; v < kCamera.height; ++v)
    for (int u = 0; u < kCamera.width; ++u) {
      const Eigen::Vector3d ray((u - kCamera.cx) / kCamera.fx, (v - kCamera.cy) / kCamera.fy, 1);
      const double z = 3 / down.dot(ray);
      image.units[static_cast<std::size_t>(v * kCamera.width + u)] = static_cast<std::uint16_t>(1000 * z + 0.5);
      cloud.points.emplace_back((z * ray).cast<float>());
    }
  EXPECT_NEAR(content_of(image, kCamera, T_map_sensor).drop_m, 3, 0.01);
  EXPECT_NEAR(content_of(cloud, kCamera, T_map_sensor).drop_m, 3, 0.01);
}

TEST(FrameContent, OfNothingIsNothing) {
  for (const DepthImage& image : {image_of(kCamera, {}), image_of(kCamera, {{65535, 1200}}), DepthImage{}}) {
    const FrameContent content = content_of(image, kCamera, kOverhead);
    EXPECT_EQ(content.returns, 0);
    EXPECT_EQ(content.range_m, 0);
  }
}

TEST(FrameContent, ALargeImagesSamplesTellTheSame) {
  const Camera large{640, 480, 500, 500, 320, 240, 0.001};
  DepthImage image = image_of(large, {{2500, 640UL * 480}});
  for (std::size_t i = 0; i < image.units.size(); i += 4) image.units[i] = 0;
  const FrameContent content = content_of(image, large, kOverhead);
  EXPECT_NEAR(content.returns, 0.75, 0.01);
  EXPECT_NEAR(content.range_m, 2.5, 1e-6);
}

TEST(FrameContent, SamplesLeaveNoColumnOutWhateverTheWidth) {
  for (const int width : {224, 352, 640, 672, 1001}) {
    const Camera camera{width, 240, 500, 500, 0.5 * width, 120, 0.001};
    DepthImage image = image_of(camera, {});
    for (std::size_t i = 0; i < image.units.size();
         ++i)  // in one column of seven and one of eleven nothing returns
      if (const std::size_t u = i % static_cast<std::size_t>(width); u % 7 != 0 && u % 11 != 0)
        image.units[i] = 2500;
    EXPECT_NEAR(content_of(image, camera, kOverhead).returns, 6.0 / 7 * 10 / 11, 0.01) << width;
  }
}

TEST(FrameContent, OfPointsCountsThoseBeforeTheSensorAgainstThePixels) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Cloud cloud{{{0, 0, -1}, {nan, 0, 2}}, {}};
  for (int i = 0; i < 300; ++i) cloud.points.emplace_back(0, 0, 2);
  const FrameContent content = content_of(cloud, kCamera, kOverhead);
  EXPECT_DOUBLE_EQ(content.returns, 300.0 / 1200);
  EXPECT_EQ(content.range_m, 2);
  for (int i = 0; i < 3000; ++i) cloud.points.emplace_back(0, 0, 2);
  EXPECT_EQ(content_of(cloud, kCamera, kOverhead).returns, 1) << "more points than pixels are all";
}

}  // namespace
}  // namespace liloc
