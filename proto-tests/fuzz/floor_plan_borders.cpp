// Drawings that somebody hands to `liloc plan`.
#include <png.h>

#include <algorithm>
#include <vector>

#include "proto-tests/fuzz/border.hpp"
#include "server/tools/plan/dxf_file.hpp"
#include "server/tools/plan/floor_image.hpp"

namespace liloc::fuzz {
namespace {

constexpr double kHighest_m = 30;  // that --height takes: the most points

/// Its room, too, as `liloc plan` makes it of the drawing.
Status check(const Result<plan::Outline>& outline) {
  if (!outline) return tl::unexpected(outline.error());
  const plan::Outline& o = *outline;
  require(o.wall.size() == static_cast<std::size_t>(o.width) * static_cast<std::size_t>(o.height),
          "the drawing is not of its size");
  require(std::ranges::find(o.wall, 1) != o.wall.end(), "the drawing has no wall");
  const auto cloud = plan::extruded(o, kHighest_m);
  if (!cloud) return tl::unexpected(cloud.error());
  require(!cloud->empty() && cloud->points.front().allFinite(), "the room has no points");
  return {};
}

/// A frame of dark pixels.
std::string small_png() {
  constexpr unsigned kSide = 24;
  std::vector<png_byte> pixels(kSide * kSide, 255);
  for (unsigned i = 4; i < 20; ++i)
    for (const unsigned at : {4 * kSide + i, 19 * kSide + i, i * kSide + 4, i * kSide + 19}) pixels[at] = 0;
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = image.height = kSide;
  image.format = PNG_FORMAT_GRAY;
  png_alloc_size_t size = 4096;
  std::string bytes(size, '\0');
  require(png_image_write_to_memory(&image, bytes.data(), &size, 0, pixels.data(), 0, nullptr) != 0,
          "the seed cannot be written");
  bytes.resize(size);
  return bytes;
}

const std::string kDxf =
    "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n6\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n"
    "0\nLINE\n10\n0\n20\n0\n11\n5\n21\n0\n0\nLWPOLYLINE\n70\n1\n10\n5\n20\n0\n42\n0."
    "4\n10\n5\n20\n4\n10\n0\n20\n4\n"
    "0\nPOLYLINE\n70\n1\n0\nVERTEX\n10\n0\n20\n4\n0\nVERTEX\n10\n0\n20\n0\n0\nSEQEND\n"
    "0\nARC\n10\n2\n20\n2\n40\n1\n50\n30\n51\n300\n0\nCIRCLE\n10\n2\n20\n2\n40\n0.5\n0\nENDSEC\n0\nEOF\n";

}  // namespace

std::vector<Border> floor_plan_borders() {
  return {
      {.name = "dxf",
       .seeds = {kDxf},
       .read = [](const auto& bytes) { return check(toolbox::read_dxf(scratch_file("a.dxf", bytes), {})); }},
      {.name = "floor-png", .seeds = {small_png()}, .read = [](const auto& bytes) {
         return check(toolbox::read_floor_image(scratch_file("floor.png", bytes), 0.2));
       }}};
}

}  // namespace liloc::fuzz
