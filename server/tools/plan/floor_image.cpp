#include "server/tools/plan/floor_image.hpp"

#include <png.h>

#include <algorithm>
#include <cstring>

#include "common/recording/files.hpp"

namespace liloc::toolbox {
namespace {

// By hand, all of them.
constexpr std::size_t kLargestFile = 64U << 20U, kMostPixels = 64'000'000;
constexpr png_byte kDark = 128;

struct Grey {
  png_image image{};
  std::vector<png_byte> pixels;
  Grey() { image.version = PNG_IMAGE_VERSION; }
  Grey(const Grey&) = delete;
  Grey& operator=(const Grey&) = delete;
  ~Grey() { png_image_free(&image); }

  [[nodiscard]] bool dark(std::size_t u, std::size_t v) const { return pixels[v * image.width + u] < kDark; }
};

Status decode(const std::string& bytes, const std::string& name, Grey& grey) {
  if (png_image_begin_read_from_memory(&grey.image, bytes.data(), bytes.size()) == 0)
    return fail("{}: is no sound PNG ({}); export it anew", name, grey.image.message);
  const std::size_t pixels = std::size_t{grey.image.width} * grey.image.height;
  if (pixels > kMostPixels)
    return fail("{}: has {} x {} pixels, over {} million; make it smaller", name, grey.image.width,
                grey.image.height, kMostPixels / 1'000'000);
  grey.image.format = PNG_FORMAT_GRAY;
  grey.pixels.resize(pixels);
  const png_color white{255, 255, 255};
  if (png_image_finish_read(&grey.image, &white, grey.pixels.data(), 0, nullptr) == 0)
    return fail("{}: is no sound PNG ({}); export it anew", name, grey.image.message);
  return {};
}

}  // namespace

Result<plan::Outline> read_floor_image(const std::filesystem::path& file, double scale_m) {
  const std::string name = file.string();
  const auto bytes = read_file(file, kLargestFile);
  if (!bytes) return tl::unexpected(bytes.error());
  Grey grey;
  if (const Status decoded = decode(*bytes, name, grey); !decoded) return tl::unexpected(decoded.error());
  const std::size_t width = grey.image.width, height = grey.image.height;
  auto outline = plan::blank_outline(
      {0, 0}, {scale_m * static_cast<double>(width), scale_m * static_cast<double>(height)});
  if (!outline) return fail("{}: {}", name, outline.error().message);
  bool any = false;
  for (std::size_t v = 0; v < height; ++v)
    for (std::size_t u = 0; u < width; ++u) {
      if (!grey.dark(u, v)) continue;
      any = true;
      // The pixel's whole square, so that coarse drawings have no gaps.
      const double low_x = scale_m * static_cast<double>(u),
                   low_y = scale_m * static_cast<double>(height - 1 - v);
      const double inner_m = std::max(0.0, scale_m - 1e-6);
      for (double y = 0; y <= inner_m; y += std::max(1e-3, std::min(inner_m, 0.5 * outline->cell_m)))
        plan::draw_wall(*outline, {low_x, low_y + y}, {low_x + inner_m, low_y + y});
    }
  if (!any) return fail("{}: has no dark pixel; draw walls dark on a light ground", name);
  return outline;
}

}  // namespace liloc::toolbox
