#include <fmt/format.h>

#include <memory>

#include "server/tools/bag_options.hpp"
#include "server/tools/command.hpp"

namespace liloc::toolbox {
namespace {

struct ConvertArguments {
  std::string in, out;
  BagArguments bag;
};

int run(const ConvertArguments& arguments) {
  const auto options = arguments.bag.options();
  if (!options) return complain(options.error(), kBadUsage);
  const auto converted = bags::convert_bag(arguments.in, arguments.out, *options);
  if (!converted) return complain(converted.error(), kBadUsage);
  for (const auto& [topic, count] : converted->messages) fmt::print("{}: {}\n", topic, count);
  fmt::print("written to {}\n", arguments.out);
  return kDone;
}

}  // namespace

void add_convert(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ConvertArguments>();
  CLI::App* command = app.add_subcommand(
      "convert",
      "Make a recording of a ROS 2 bag: rosbag2 (sqlite3) or MCAP, as a file or as the folder of one");
  command->add_option("IN", arguments->in, "The bag")->required();
  command->add_option("OUT", arguments->out, "Folder of the recording; must be new")->required();
  command->add_option("--device", arguments->bag.devices,
                      "ID=TOPIC of a device's depth Image; may be repeated");
  add_bag_options(*command, arguments->bag);
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace liloc::toolbox
