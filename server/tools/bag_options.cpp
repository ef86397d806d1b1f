#include "server/tools/bag_options.hpp"

#include "common/command/checks.hpp"
#include "common/command/text.hpp"

namespace liloc::toolbox {
namespace {

template <class Value>
Status take(const char* flag, const std::vector<std::string>& given, std::map<std::string, Value>& values) {
  for (const std::string& text : given) {
    const std::size_t equals = text.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == text.size())
      return fail("{}: '{}' is not ID=VALUE, e.g. {} ceiling0=/ceiling0/depth/image_rect_raw", flag, text,
                  flag);
    if (!values.emplace(text.substr(0, equals), text.substr(equals + 1)).second)
      return fail("{}: {} is given twice", flag, text.substr(0, equals));
  }
  return {};
}

}  // namespace

Result<bags::ConvertOptions> BagArguments::options() const {
  bags::ConvertOptions options;
  for (const Status& taken :
       {take("--lidar", lidars, options.lidars), take("--device", devices, options.devices),
        take("--imu", imus, options.imus), take("--truth", truths, options.truths),
        take("--device-file", device_files, options.device_files)})
    if (!taken) return tl::unexpected(taken.error());
  if (!site.empty() && !world.empty()) return fail("--world: the file of --site names it; leave one out");
  if (still_seconds && devices.empty()) return fail("--still-seconds: there is no --device; give both");
  options.site_file = site;
  if (!world.empty()) options.world_frame = world;
  options.still_seconds = still_seconds;
  return options;
}

std::vector<std::string> left_out_lines(const bags::Converted& converted) {
  std::vector<std::string> lines;
  for (const auto& [topic, of] : converted.left_out)
    lines.push_back(command::one_line(fmt::format(
        "{}: {} messages cannot be used and are left out; the first {}", topic, of.messages, of.first)));
  return lines;
}

void add_bag_options(CLI::App& command, BagArguments& arguments) {
  auto* bag = command.add_option_group("bag");
  const auto each = [&](const char* flag, std::vector<std::string>& values, const char* help) {
    bag->add_option(flag, values, help)->allow_extra_args(false);
  };
  each("--lidar", arguments.lidars, "ID=TOPIC of a ceiling LiDAR's Image or PointCloud2; may be repeated");
  each("--imu", arguments.imus, "ID=TOPIC of a device's Imu; may be repeated");
  each("--truth", arguments.truths, "ID=FILE: a device's true poses, TUM; may be repeated");
  each("--device-file", arguments.device_files,
       "ID=device.json with a device's intrinsics, depth scale and T_imu_sensor; else from camera_info and tf "
       "of "
       "the bag, in millimetres");
  bag->add_option(
      "--site", arguments.site,
      "site.json with the LiDARs' intrinsics, depth scale and extrinsics; else from camera_info and "
      "tf of the bag, in millimetres");
  bag->add_option("--world", arguments.world, "The map's frame in tf; else map");
  bag->add_option("--still-seconds", arguments.still_seconds,
                  "The devices stand still for so long at the start; else as --device-file says, or 0")
      ->check(command::in_range(0.0, 60.0));
}

}  // namespace liloc::toolbox
