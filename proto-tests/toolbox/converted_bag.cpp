#include "proto-tests/toolbox/converted_bag.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <system_error>
#include <utility>

#include "common/recording/bags/bag.hpp"
#include "proto-tests/replay/processes.hpp"

namespace liloc::toolbox {

namespace fs = std::filesystem;

ConvertedBag::~ConvertedBag() {
  std::error_code ignored;
  if (!folder_.empty()) fs::remove_all(folder_, ignored);
}

Conversion<void> ConvertedBag::take(replay::ReplayOptions& options, BagArguments bag) {
  const std::string given = options.recording.string();
  if (!bags::is_bag(options.recording)) {
    if (!bag.any() && !bag.still_seconds) return {};
    return fail("{}: is no bag; leave out the options of bags", given);
  }
  bag.devices = std::exchange(options.devices, {});
  auto convert = bag.options();
  if (!convert) return tl::unexpected(convert.error());
  convert->stopped = [] { return replay::stop_requested(); };
  if (const auto valid = options.validated(); !valid) return tl::unexpected(valid.error());
  std::string pattern = fs::temp_directory_path() / "liloc-bag-XXXXXX";
  if (mkdtemp(pattern.data()) == nullptr)
    return unwritten({fmt::format("{}: cannot be made; set TMPDIR to a folder", pattern)});
  folder_ = pattern;
  const fs::path recording = folder_ / "recording";
  const auto converted = bags::convert_bag(given, recording, *convert);
  if (!converted) return tl::unexpected(converted.error());
  for (const std::string& line : left_out_lines(*converted)) fmt::print(stderr, "liloc: replay: {}\n", line);
  options.recording = recording;
  return {};
}

}  // namespace liloc::toolbox
