#include <fmt/format.h>

#include <memory>

#include "common/base/ids.hpp"
#include "common/base/stop_signals.hpp"
#include "common/recording/bags/bag.hpp"
#include "common/recording/new_folder.hpp"
#include "common/recording/tum_folder.hpp"
#include "server/tools/bag_options.hpp"
#include "server/tools/command.hpp"

namespace liloc::toolbox {
namespace {

struct ConvertArguments {
  std::string in, out, to = "recording";
  std::vector<double> camera;  ///< width, height, fx, fy, cx, cy
  BagArguments bag;
};

using Stopped = std::function<bool()>;

Conversion<void> convert_bag(const ConvertArguments& arguments, const Stopped& stopped) {
  if (!arguments.camera.empty()) return fail("--camera: is of a TUM sequence; of a bag give --device-file");
  auto options = arguments.bag.options();
  if (!options) return tl::unexpected(options.error());
  options->stopped = stopped;
  const auto converted = bags::convert_bag(arguments.in, arguments.out, *options);
  if (!converted) return tl::unexpected(converted.error());
  for (const auto& [topic, count] : converted->messages) fmt::print("{}: {}\n", topic, count);
  for (const std::string& line : left_out_lines(*converted)) fmt::print("{}\n", line);
  return {};
}

Result<DeviceInfo> device_of_tum(const ConvertArguments& arguments) {
  if (arguments.bag.devices.size() != 1 || arguments.bag.any())
    return fail("{}: is a TUM sequence; give --device ID and --camera, and no option of bags", arguments.in);
  const auto id = valid_id(arguments.bag.devices.front(), "--device");
  if (!id) return tl::unexpected(id.error());
  const std::vector<double>& c = arguments.camera;
  if (c.size() != 6)
    return fail("--camera: missing; give WIDTH,HEIGHT,FX,FY,CX,CY, of a Kinect 640,480,525,525,319.5,239.5");
  const auto camera =
      Camera{static_cast<int>(c[0]), static_cast<int>(c[1]), c[2], c[3], c[4], c[5]}.validated("--camera");
  if (!camera) return tl::unexpected(camera.error());
  DeviceInfo device;
  device.id = *id;
  device.camera = *camera;
  device.still_seconds = arguments.bag.still_seconds.value_or(0);
  return device;
}

Conversion<void> convert_tum(const ConvertArguments& arguments, const Stopped& stopped) {
  auto device = device_of_tum(arguments);
  if (!device) return tl::unexpected(device.error());
  auto folder = NewFolder::beside(arguments.out);
  if (!folder) return tl::unexpected(folder.error());
  const auto frames = tum_to_device(arguments.in, folder->path(), std::move(*device), stopped);
  if (!frames) return tl::unexpected(frames.error());
  if (const Status kept = folder->keep(); !kept) return unwritten(kept.error());
  fmt::print("{}: {} frames; to replay it, add a site.json and its ceiling's global/\n",
             arguments.bag.devices.front(), *frames);
  return {};
}

Conversion<void> convert_to_tum(const ConvertArguments& arguments, const Stopped& stopped) {
  const BagArguments& bag = arguments.bag;
  if (bag.any() || !bag.devices.empty() || bag.still_seconds || !arguments.camera.empty())
    return fail("--to tum: takes all devices of a recording as they are; leave out the other options");
  const auto recording = open_recording(arguments.in);
  if (!recording) return tl::unexpected(recording.error());
  if (recording->devices.empty()) return fail("{}: has no device, which TUM sequences are of", arguments.in);
  auto folder = NewFolder::beside(arguments.out);
  if (!folder) return tl::unexpected(folder.error());
  for (const DeviceRecording& device : recording->devices) {
    if (auto written = device_to_tum(device, folder->path() / device.info.id, stopped); !written)
      return written;
    fmt::print("{}: {} frames\n", device.info.id, device.depth.size());
  }
  if (const Status kept = folder->keep(); !kept) return unwritten(kept.error());
  return {};
}

Conversion<void> convert(const ConvertArguments& arguments, const Stopped& stopped) {
  if (arguments.to == "tum") return convert_to_tum(arguments, stopped);
  return is_tum_folder(arguments.in) ? convert_tum(arguments, stopped) : convert_bag(arguments, stopped);
}

int run(const ConvertArguments& arguments) {
  const StopSignals signals;
  bool stopped = false;
  const auto done = convert(
      arguments, [&] { return stopped = stopped || signals.within(std::chrono::milliseconds(0)) != 0; });
  if (!done) return complain({done.error().message}, stopped || done.error().unwritten ? kFailed : kBadUsage);
  fmt::print("written to {}\n", arguments.out);
  return kDone;
}

}  // namespace

void add_convert(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ConvertArguments>();
  CLI::App* command = app.add_subcommand(
      "convert", "Make a recording of a ROS 2 bag or a TUM RGB-D sequence, or sequences of a recording");
  command
      ->add_option("IN", arguments->in,
                   "A bag (.mcap, .db3, or the folder of them), a folder with depth.txt, or a recording")
      ->required();
  command->add_option("OUT", arguments->out, "Folder to write; must be new")->required();
  command
      ->add_option("--to", arguments->to,
                   "recording, or tum: each device of the recording IN as a sequence of its own")
      ->check(CLI::IsMember({"recording", "tum"}))
      ->capture_default_str();
  command
      ->add_option("--device", arguments->bag.devices,
                   "ID=TOPIC of a device's depth Image, may be repeated; of a TUM sequence its ID")
      ->allow_extra_args(false);
  command
      ->add_option("--camera", arguments->camera,
                   "WIDTH,HEIGHT,FX,FY,CX,CY in pixels of a TUM sequence, whose depth is 5000 a metre")
      ->delimiter(',')
      ->expected(6);
  add_bag_options(*command, arguments->bag);
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace liloc::toolbox
