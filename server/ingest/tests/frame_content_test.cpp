#include "server/ingest/frame_content.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

namespace liloc {
namespace {

constexpr Camera kCamera{40, 30, 40, 40, 20, 15, 0.001};

/// So many pixels at each depth, in units; the others have no return.
DepthImage image_of(const Camera& camera, const std::vector<std::pair<std::uint16_t, std::size_t>>& depths) {
  DepthImage image{1, camera.width, camera.height, {}};
  for (const auto& [units, count] : depths) image.units.insert(image.units.end(), count, units);
  image.units.resize(static_cast<std::size_t>(camera.width) * static_cast<std::size_t>(camera.height), 0);
  return image;
}

TEST(FrameContent, TellsReturnsWhatIsUsableAndRanges) {
  const FrameContent content = content_of(image_of(kCamera, {{2000, 600}, {3000, 200}, {100, 100}}), kCamera);
  EXPECT_DOUBLE_EQ(content.returns, 900.0 / 1200);
  EXPECT_DOUBLE_EQ(content.usable, 800.0 / 900) << "10 cm is nearer than registration uses";
  EXPECT_NEAR(content.range_m, 2, 1e-6);
  EXPECT_NEAR(content.far_m, 3, 1e-6);
}

TEST(FrameContent, OfNothingIsNothing) {
  for (const DepthImage& image : {image_of(kCamera, {}), image_of(kCamera, {{65535, 1200}}), DepthImage{}}) {
    const FrameContent content = content_of(image, kCamera);
    EXPECT_EQ(content.returns, 0);
    EXPECT_EQ(content.range_m, 0);
  }
}

TEST(FrameContent, ALargeImagesSamplesTellTheSame) {
  const Camera large{640, 480, 500, 500, 320, 240, 0.001};
  DepthImage image = image_of(large, {{2500, 640UL * 480}});
  for (std::size_t i = 0; i < image.units.size(); i += 4) image.units[i] = 0;
  const FrameContent content = content_of(image, large);
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
    EXPECT_NEAR(content_of(image, camera).returns, 6.0 / 7 * 10 / 11, 0.01) << width;
  }
}

TEST(FrameContent, OfPointsCountsThoseBeforeTheSensorAgainstThePixels) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  Cloud cloud{{{0, 0, -1}, {nan, 0, 2}}, {}};
  for (int i = 0; i < 300; ++i) cloud.points.emplace_back(0, 0, 2);
  const FrameContent content = content_of(cloud, kCamera);
  EXPECT_DOUBLE_EQ(content.returns, 300.0 / 1200);
  EXPECT_EQ(content.range_m, 2);
  for (int i = 0; i < 3000; ++i) cloud.points.emplace_back(0, 0, 2);
  EXPECT_EQ(content_of(cloud, kCamera).returns, 1) << "more points than pixels are all";
}

}  // namespace
}  // namespace liloc
