#include "server/tools/plan/floor_image.hpp"

#include <gmock/gmock.h>
#include <png.h>

#include <algorithm>

#include "common/recording/files.hpp"
#include "common/recording/tests/temporary_folder.hpp"

namespace liloc::toolbox {
namespace {

using testing::HasSubstr;

/// A room of `side` pixels with walls of two pixels and a margin of ten.
std::vector<png_byte> drawn(unsigned side, png_byte wall) {
  const unsigned all = side + 20;
  std::vector<png_byte> pixels(std::size_t{all} * all, 255);
  for (unsigned v = 10; v < 10 + side; ++v)
    for (unsigned u = 10; u < 10 + side; ++u)
      if (u < 12 || v < 12 || u >= 8 + side || v >= 8 + side) pixels[std::size_t{v} * all + u] = wall;
  return pixels;
}

class FloorImage : public testing::Test {
 protected:
  [[nodiscard]] std::filesystem::path written(const std::vector<png_byte>& pixels, unsigned side) const {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = image.height = side;
    image.format = PNG_FORMAT_GRAY;
    const auto file = folder_.path() / "plan.png";
    EXPECT_NE(png_image_write_to_file(&image, file.c_str(), 0, pixels.data(), 0, nullptr), 0);
    return file;
  }
  TemporaryFolder folder_;
};

TEST_F(FloorImage, ItsDarkPixelsAreWalls) {
  for (const auto& [side, scale_m] : {std::pair{300U, 0.02}, {60U, 0.1}, {20U, 0.3}}) {
    const auto outline = read_floor_image(written(drawn(side, 30), side + 20), scale_m);
    ASSERT_TRUE(outline) << outline.error().message;
    const auto cloud = plan::extruded(*outline, 2.8);
    ASSERT_TRUE(cloud) << cloud.error().message;
    const auto level = std::ranges::count_if(cloud->points, [](const auto& p) { return p.z() > 2.79F; });
    const double inner_m = (side - 4) * scale_m;
    EXPECT_NEAR(0.05 * 0.05 * static_cast<double>(level), inner_m * inner_m, 2) << side;
  }
}

TEST_F(FloorImage, APictureWithoutWallsIsNamed) {
  EXPECT_THAT(read_floor_image(written(drawn(100, 200), 120), 0.05).error().message,
              HasSubstr("no dark pixel"));
}

TEST_F(FloorImage, AScaleThatCannotBeIsNamed) {
  const auto file = written(drawn(100, 0), 120);
  EXPECT_THAT(read_floor_image(file, 5).error().message, HasSubstr("--scale"));
  EXPECT_THAT(read_floor_image(file, 0.001).error().message, HasSubstr("--scale"));
}

TEST_F(FloorImage, WhatIsNoPngIsNamed) {
  const auto file = folder_.path() / "no.png";
  ASSERT_TRUE(write_file(file, "P5 3 3 255"));
  EXPECT_THAT(read_floor_image(file, 0.05).error().message, HasSubstr("no sound PNG"));
  const auto whole = read_file(written(drawn(100, 0), 120), 1 << 20).value();
  ASSERT_TRUE(write_file(file, whole.substr(0, whole.size() / 2)));
  EXPECT_THAT(read_floor_image(file, 0.05).error().message, HasSubstr("no sound PNG"));
  EXPECT_THAT(read_floor_image(folder_.path() / "absent.png", 0.05).error().message, HasSubstr("absent.png"));
}

}  // namespace
}  // namespace liloc::toolbox
