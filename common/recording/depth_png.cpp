// 16-bit greyscale PNG. libpng reports by longjmp, which skips destructors: so each function that calls setjmp
// holds nothing but plain pointers, and all buffers belong to its caller.
#include <png.h>

#include <bit>
#include <csetjmp>
#include <cstring>

#include "common/geometry/depth.hpp"
#include "common/recording/files.hpp"
#include "common/recording/writer.hpp"

namespace liloc {
namespace {

struct Stream {  // what libpng's callbacks read from or append to
  const std::string* in = nullptr;
  std::size_t position = 0;
  std::string out;
  char reason[96] = "";
};

[[noreturn]] void on_error(png_structp png, png_const_charp text) {
  auto* stream = static_cast<Stream*>(png_get_error_ptr(png));
  std::strncpy(stream->reason, text, sizeof(stream->reason) - 1);
  png_longjmp(png, 1);
}

void on_warning(png_structp, png_const_charp) {}

void on_read(png_structp png, png_bytep to, std::size_t size) {
  auto* stream = static_cast<Stream*>(png_get_io_ptr(png));
  if (size > stream->in->size() - stream->position) png_error(png, "the file ends too early");
  std::memcpy(to, stream->in->data() + stream->position, size);
  stream->position += size;
}

void on_write(png_structp png, png_bytep from, std::size_t size) {
  static_cast<Stream*>(png_get_io_ptr(png))->out.append(reinterpret_cast<const char*>(from), size);
}

void on_flush(png_structp) {}

struct Reader {
  Stream stream;
  png_structp png = png_create_read_struct(PNG_LIBPNG_VER_STRING, &stream, on_error, on_warning);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  Reader() = default;
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() { png_destroy_read_struct(&png, &info, nullptr); }
};

struct Writer {
  Stream stream;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &stream, on_error, on_warning);
  png_infop info = png ? png_create_info_struct(png) : nullptr;
  Writer() = default;
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() { png_destroy_write_struct(&png, &info); }
};

bool read_header(Reader& reader) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  png_set_read_fn(reader.png, &reader.stream, on_read);
  png_set_chunk_malloc_max(reader.png, 1 << 20);
  png_read_info(reader.png, reader.info);
  return true;
}

bool read_rows(Reader& reader, png_bytepp rows) {
  if (setjmp(png_jmpbuf(reader.png))) return false;
  if constexpr (std::endian::native == std::endian::little) png_set_swap(reader.png);
  png_set_interlace_handling(reader.png);
  png_read_update_info(reader.png, reader.info);
  png_read_image(reader.png, rows);
  png_read_end(reader.png, nullptr);
  return true;
}

bool write_all(Writer& writer, png_uint_32 width, png_uint_32 height, png_bytepp rows) {
  if (setjmp(png_jmpbuf(writer.png))) return false;
  png_set_write_fn(writer.png, &writer.stream, on_write, on_flush);
  png_set_compression_level(writer.png, 1);  // a live writer has little time; level 6 saves only a tenth
  png_set_filter(writer.png, PNG_FILTER_TYPE_BASE, PNG_FILTER_SUB);
  png_set_IHDR(writer.png, writer.info, width, height, 16, PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(writer.png, writer.info);
  if constexpr (std::endian::native == std::endian::little) png_set_swap(writer.png);
  png_write_image(writer.png, rows);
  png_write_end(writer.png, nullptr);
  return true;
}

std::vector<png_bytep> rows_of(std::uint16_t* units, std::size_t width, std::size_t height) {
  std::vector<png_bytep> rows(height);
  for (std::size_t v = 0; v < height; ++v) rows[v] = reinterpret_cast<png_bytep>(units + v * width);
  return rows;
}

}  // namespace

Result<DepthImage> read_depth(const DepthFile& file, const Camera& camera) {
  const std::string name = file.path.string();
  const auto checked = camera.validated(name + ": camera");
  if (!checked) return tl::unexpected(checked.error());
  const auto width = static_cast<std::size_t>(camera.width), height = static_cast<std::size_t>(camera.height);
  const auto bytes = read_file(file.path, 4 * width * height + (1 << 20));
  if (!bytes) return tl::unexpected(bytes.error());
  Reader reader;
  if (reader.info == nullptr) return fail("{}: out of memory; close other programs", name);
  reader.stream.in = &*bytes;
  if (!read_header(reader)) return fail("{}: is no sound PNG ({}); record it anew", name, reader.stream.reason);
  const std::size_t got_width = png_get_image_width(reader.png, reader.info),
                    got_height = png_get_image_height(reader.png, reader.info);
  if (png_get_bit_depth(reader.png, reader.info) != 16 ||
      png_get_color_type(reader.png, reader.info) != PNG_COLOR_TYPE_GRAY)
    return fail("{}: has {} bits and {} channel(s); depth is 16-bit greyscale", name,
                int{png_get_bit_depth(reader.png, reader.info)},
                int{png_get_channels(reader.png, reader.info)});
  if (got_width != width || got_height != height)
    return fail("{}: is {}x{}, its intrinsics are for {}x{}; correct one of them", name, got_width, got_height,
                width, height);
  DepthImage image{file.stamp_ns, camera.width, camera.height, std::vector<std::uint16_t>(width * height)};
  auto rows = rows_of(image.units.data(), width, height);
  if (!read_rows(reader, rows.data()))
    return fail("{}: is no sound PNG ({}); record it anew", name, reader.stream.reason);
  mark_missing(image);
  return image;
}

Status write_depth(const std::filesystem::path& folder, const DepthImage& image) {
  const auto file = folder / fmt::format("{}.png", image.stamp_ns);
  const auto width = static_cast<std::size_t>(image.width), height = static_cast<std::size_t>(image.height);
  if (image.stamp_ns < 0 || image.width < 1 || image.height < 1 || image.units.size() != width * height)
    return fail("{}: depth image is {}x{} with {} values; give a whole image with a stamp from 0",
                file.string(), image.width, image.height, image.units.size());
  Writer writer;
  if (writer.info == nullptr) return fail("{}: out of memory; close other programs", file.string());
  writer.stream.out.reserve(image.units.size() * 2);
  auto rows = rows_of(const_cast<std::uint16_t*>(image.units.data()), width, height);  // libpng only reads them
  if (!write_all(writer, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), rows.data()))
    return fail("{}: cannot be encoded: {}", file.string(), writer.stream.reason);
  return write_file(file, writer.stream.out);
}

}  // namespace liloc
