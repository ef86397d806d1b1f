// The files of a recording: depth images, descriptions, tables.
#include <zlib.h>

#include "common/recording/files.hpp"
#include "common/recording/writer.hpp"
#include "proto-tests/fuzz/border.hpp"

namespace liloc::fuzz {
namespace {

const Camera kCamera{8, 4, 8, 8, 3.5, 1.5, 0.001};

template <class T>
Status status_of(const Result<T>& result) {
  return result ? Status() : tl::unexpected(result.error());
}

/// What `write` puts into the file of that name.
template <class Write>
std::string written(const std::string& name, Write write) {
  const std::string file = scratch_file(name, "");
  require(write(file).has_value(), "a seed cannot be written");
  return read_file(file, 1 << 20).value();
}

std::uint32_t big_endian(const std::string& bytes, std::size_t at) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = value << 8 | static_cast<unsigned char>(bytes[at + i]);
  return value;
}

/// PNG: eight bytes, then chunks of length, four letters, data, CRC of letters and data.
void mend_png(std::string& bytes) {
  std::size_t at = 8;
  while (at + 12 <= bytes.size()) {
    const std::size_t length = big_endian(bytes, at);
    if (length > bytes.size() - at - 12) return;
    const auto crc = static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const Bytef*>(bytes.data() + at + 4), static_cast<uInt>(length + 4)));
    for (std::size_t i = 0; i < 4; ++i)
      bytes[at + 8 + length + i] = static_cast<char>(crc >> (24 - 8 * i) & 0xff);
    at += 12 + length;
  }
}

Status read_png(const std::string& bytes) {
  const auto image = read_depth({1, scratch_file("1.png", bytes)}, kCamera);
  if (!image) return status_of(image);
  require(image->units.size() == 32, "the image has another size");
  return {};
}

std::string png_seed() {
  const DepthImage image{1, 8, 4, std::vector<std::uint16_t>(32, 1234)};
  const std::filesystem::path folder = std::filesystem::path(scratch_file("1.png", "")).parent_path();
  require(write_depth(folder, image).has_value(), "a seed cannot be written");
  return read_file(folder / "1.png", 1 << 20).value();
}

}  // namespace

std::vector<Border> recording_borders() {
  const Site site{"map",
                  {{"ceiling0", kCamera, 6, Pose::Identity()}, {"ceiling1", kCamera, 6, Pose::Identity()}}};
  const DeviceInfo device{"robot1", kCamera, 30, 1, 200.0, Pose::Identity()};
  return {
      {.name = "png", .seeds = {png_seed()}, .read = read_png, .mend = mend_png},
      {.name = "site-json",
       .seeds = {written("site.json", [&](const auto& file) { return write_site(file, site); })},
       .read = [](const auto& bytes) { return status_of(read_site(scratch_file("site.json", bytes))); }},
      {.name = "device-json",
       .seeds = {written("device.json", [&](const auto& file) { return write_device(file, device); })},
       .read = [](const auto& bytes) { return status_of(read_device(scratch_file("device.json", bytes))); }},
      {.name = "imu-csv",
       .seeds =
           {"#timestamp_ns,wx,wy,wz,ax,ay,az\n1700000000000000000,0.1,-2e-3,0,0,0,9.81\n1700000000005000000,"
            "0,0,0,0,0,9.8\n"},
       .read = [](const auto& bytes) { return status_of(read_imu(scratch_file("imu.csv", bytes))); }},
      {.name = "tum",
       .seeds =
           {"# t tx ty tz qx qy qz qw\n1700000000.000000001 1 2 3 0 0 0 1\n1700000000.1 1 2 3.5 0 0 1 0\n"},
       .read = [](const auto& bytes) { return status_of(read_tum(scratch_file("poses.tum", bytes))); }},
  };
}

}  // namespace liloc::fuzz
