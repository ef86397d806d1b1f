#include "common/recording/tum_folder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/recording/files.hpp"
#include "common/recording/table_rows.hpp"
#include "common/recording/writer.hpp"

namespace liloc {
namespace {

namespace fs = std::filesystem;

/// A path of a stranger's table may lead anywhere.
bool stays_inside(const fs::path& relative) {
  return !relative.empty() && relative.is_relative() && std::ranges::find(relative, "..") == relative.end();
}

Result<std::vector<DepthFile>> list_frames(const fs::path& tum) {
  const fs::path file = tum / "depth.txt";
  const auto text = read_file(file, kLargestTableBytes);
  if (!text) return tl::unexpected(text.error());
  std::vector<DepthFile> frames;
  const Status read = for_each_row(*text, [&](std::size_t number, std::string_view line) -> Status {
    DepthFile frame;
    const bool stamped = parse_seconds(next_cell(line), frame.stamp_ns);
    const fs::path image(next_cell(line));
    if (!stamped || !next_cell(line).empty() || !stays_inside(image))
      return fail("{}: line {} is not t depth/FILE.png; mend or drop it", file.string(), number);
    if (!frames.empty() && frame.stamp_ns <= frames.back().stamp_ns)
      return fail("{}: line {}: t does not rise; sort the rows", file.string(), number);
    frame.path = tum / image;
    frames.push_back(std::move(frame));
    return {};
  });
  if (!read) return tl::unexpected(read.error());
  if (frames.empty()) return fail("{}: names no image; give a sequence with depth", file.string());
  return frames;
}

double rate_hz(const std::vector<DepthFile>& frames) {
  const double seconds = 1e-9 * static_cast<double>(frames.back().stamp_ns - frames.front().stamp_ns);
  return seconds > 0 ? std::clamp(static_cast<double>(frames.size() - 1) / seconds, 0.1, 1000.0) : 1.0;
}

void rescale(DepthImage& image, double factor) {
  for (std::uint16_t& units : image.units) {
    const double scaled = std::round(units * factor);
    units = scaled <= std::numeric_limits<std::uint16_t>::max() ? static_cast<std::uint16_t>(scaled) : 0;
  }
}

}  // namespace

bool is_tum_folder(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder / "depth.txt", error) && !fs::exists(folder / "site.json", error);
}

Conversion<std::size_t> tum_to_device(const fs::path& tum, const fs::path& out, DeviceInfo device,
                                      const std::function<bool()>& stopped) {
  const auto frames = list_frames(tum);
  if (!frames) return tl::unexpected(frames.error());
  device.camera.depth_scale_m = kTumDepthScale_m;
  device.rate_hz = rate_hz(*frames);
  const fs::path folder = out / "devices" / device.id;
  for (const DepthFile& frame : *frames) {
    if (stopped && stopped()) return fail("{}: stopped by a signal", tum.string());
    const auto image = read_depth(frame, device.camera);
    if (!image) return tl::unexpected(image.error());
    if (const Status written = write_depth(folder / "depth", *image); !written)
      return unwritten(written.error());
  }
  std::error_code error;
  if (fs::exists(tum / "groundtruth.txt", error)) {
    const auto truth = read_tum(tum / "groundtruth.txt");
    if (!truth) return tl::unexpected(truth.error());
    if (const Status written = write_tum(folder / "groundtruth.tum", *truth); !written)
      return unwritten(written.error());
  }
  if (const Status written = write_device(folder / "device.json", device); !written)
    return unwritten(written.error());
  return frames->size();
}

Conversion<void> device_to_tum(const DeviceRecording& device, const fs::path& out,
                               const std::function<bool()>& stopped) {
  std::string table = "# depth maps, 5000 units a metre\n# timestamp filename\n";
  for (const DepthFile& frame : device.depth) {
    if (stopped && stopped()) return fail("{}: stopped by a signal", out.string());
    auto image = read_depth(frame, device.info.camera);
    if (!image) return tl::unexpected(image.error());
    rescale(*image, device.info.camera.depth_scale_m / kTumDepthScale_m);
    if (const Status written = write_depth(out / "depth", *image); !written) return unwritten(written.error());
    fmt::format_to(std::back_inserter(table), "{} depth/{}.png\n", seconds_text(frame.stamp_ns),
                   frame.stamp_ns);
  }
  const auto truth = read_ground_truth(device);
  if (!truth) return tl::unexpected(truth.error());
  if (!truth->empty())
    if (const Status written = write_tum(out / "groundtruth.txt", *truth); !written)
      return unwritten(written.error());
  if (const Status written = write_file(out / "depth.txt", table); !written) return unwritten(written.error());
  return {};
}

}  // namespace liloc
