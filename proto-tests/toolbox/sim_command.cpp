#include <fmt/format.h>

#include <memory>
#include <thread>

#include "common/base/line_limit.hpp"
#include "common/command/checks.hpp"
#include "proto-tests/replay/processes.hpp"
#include "proto-tests/sim/write_recording.hpp"
#include "proto-tests/toolbox/commands.hpp"
#include "proto-tests/toolbox/live_site.hpp"

namespace liloc::toolbox {
namespace {

struct SimArguments {
  std::string out, kind = "office", device_kind = "carried", lidar_sensor = "l515", device_sensor = "l515";
  std::filesystem::path describe;
  std::string credentials;
  bool live = false;
  int domain = 0;
  bool seconds_given = false;
  sim::SimOptions options;
};

Result<sim::SimOptions> checked_options(const SimArguments& arguments) {
  sim::SimOptions options = arguments.options;
  const auto kind = sim::site_kind_of(arguments.kind);
  if (!kind) return tl::unexpected(kind.error());
  const auto device_kind = sim::device_kind_of(arguments.device_kind);
  if (!device_kind) return tl::unexpected(device_kind.error());
  const auto lidar_sensor = sim::sensor_model_of(arguments.lidar_sensor);
  if (!lidar_sensor) return tl::unexpected(lidar_sensor.error());
  const auto device_sensor = sim::sensor_model_of(arguments.device_sensor);
  if (!device_sensor) return tl::unexpected(device_sensor.error());
  options.lidar_sensor = *lidar_sensor;
  options.device_sensor = *device_sensor;
  options.kind = *kind;
  options.device_kind = *device_kind;
  if (arguments.live && !arguments.seconds_given) options.seconds = 3600;
  return options.validated();
}

int write(const SimArguments& arguments, const sim::SimOptions& options) {
  ProgressBar bar("simulating");
  if (auto status = sim::write_recording(options, arguments.out, [&](double share) { bar.show(share); });
      !status)
    return complain(status.error(), kFailed);
  fmt::print("{} s, {} LiDARs, {} devices, {} people written to {}\n", options.seconds, options.lidars,
             options.devices, options.people, arguments.out);
  return kDone;
}

/// A line in five seconds at most.
void say_dropped(std::size_t more, std::size_t* told, LineLimit* limit) {
  if (more == 0 || !limit->pass(std::chrono::steady_clock::now())) return;
  *told += more;
  fmt::print(stderr,
             "liloc: sim: behind real time: {} images left out; ask for fewer sensors, a smaller image or more "
             "--threads\n",
             more);
}

int stream(const SimArguments& arguments, const sim::SimOptions& options) {
  replay::catch_stop_signals();
  auto site = LiveSite::create(options, arguments.domain, arguments.credentials);
  if (!site) return complain(site.error(), kFailed);
  if (!arguments.describe.empty()) {
    if (auto status = (*site)->describe(arguments.describe); !status) return complain(status.error(), kFailed);
    fmt::print("site.json and a json file per device written to {}\n", arguments.describe.string());
  }
  fmt::print("streaming {} LiDARs and {} devices on DDS domain {}; Ctrl-C ends it\n", options.lidars,
             options.devices, arguments.domain);
  std::fflush(stdout);
  (*site)->start();
  LineLimit limit;
  std::size_t told = 0;
  while (!(*site)->over() && !replay::stop_requested()) {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    say_dropped((*site)->dropped() - told, &told, &limit);
  }
  if (const std::size_t dropped = (*site)->dropped(); dropped > 0)
    fmt::print(stderr, "liloc: sim: {} images were left out in all\n", dropped);
  if (auto status = (*site)->trouble(); !status) return complain(status.error(), kFailed);
  return kDone;
}

int run(const SimArguments& arguments) {
  const auto options = checked_options(arguments);
  if (!options) return complain(options.error(), kBadUsage);
  if (arguments.live && !arguments.out.empty())
    return complain({"sim: OUT and --live exclude each other; record or stream"}, kBadUsage);
  if (!arguments.live && arguments.out.empty())
    return complain({"sim: OUT is missing; name the recording's folder, or stream with --live"}, kBadUsage);
  return arguments.live ? stream(arguments, *options) : write(arguments, *options);
}

void add_site_options(CLI::App& command, SimArguments& arguments) {
  sim::SimOptions& o = arguments.options;
  command.add_option("--kind", arguments.kind, "Of the site: office, corridor, symmetric or area")
      ->capture_default_str();
  command.add_option("--world", o.world, "Whose furniture, people and mounts: 1, or 2 as another simulator's")
      ->capture_default_str();
  command
      .add_option("--lidar-sensor", arguments.lidar_sensor, "On the ceiling: l515, l515-real, kinect or tof")
      ->capture_default_str();
  command.add_option("--width", o.width_m, "Of the site in metres; 0: by the seed")->capture_default_str();
  command.add_option("--depth", o.depth_m, "Of the site in metres; 0: by the seed")->capture_default_str();
  command.add_option("--height", o.height_m, "Of the site in metres; 0: by the seed")->capture_default_str();
  command.add_option("--clutter", o.clutter, "Scales how much furniture stands about")->capture_default_str();
  command.add_option("--people", o.people, "Walking about")->capture_default_str();
  command
      .add_option("--moved", o.moved_items,
                  "Furniture moved since the reference scan; -1: half as many as people")
      ->capture_default_str();
  command
      .add_option("--pushed", o.pushed_items, "Furniture pushed during the run; -1: a third as many as people")
      ->capture_default_str();
  command.add_option("--lidars", o.lidars, "Ceiling LiDARs")->capture_default_str();
  command.add_option("--lidar-rate", o.lidar_rate_hz, "Their frames per second")->capture_default_str();
}

void add_device_options(CLI::App& command, SimArguments& arguments) {
  sim::SimOptions& o = arguments.options;
  command.add_option("--devices", o.devices, "To be located")->capture_default_str();
  command.add_option("--device-kind", arguments.device_kind, "carried or robot")->capture_default_str();
  command
      .add_option("--device-sensor", arguments.device_sensor, "In the devices: l515, l515-real, kinect or tof")
      ->capture_default_str();
  command.add_option("--device-rate", o.device_rate_hz, "Their frames per second; 0: 15 carried, 10 robot")
      ->capture_default_str();
  command.add_option("--speed", o.device_speed_m_s, "In m/s; 0: by the seed")->capture_default_str();
  command.add_option("--still", o.still_seconds, "Devices stand still for so long first")
      ->capture_default_str();
  command.add_option("--imu-rate", o.imu_rate_hz, "IMU samples per second; 0: no IMU")->capture_default_str();
  command.add_option("--clock-offset-ms", o.device_clock_offset_ms, "Devices' clocks run ahead by so much")
      ->capture_default_str();
  command.add_option("--image-width", o.image_width, "Of all depth images")->capture_default_str();
  command.add_option("--image-height", o.image_height, "Of all depth images")->capture_default_str();
  command.add_option("--noise", o.noise, "Scales the depth noise; 0: exact")->capture_default_str();
  command.add_option("--imu-noise", o.imu_noise, "Scales the IMU's noise and bias")->capture_default_str();
}

void add_fault_options(CLI::App& command, sim::SimOptions& o) {
  command.add_option("--gap-start", o.ceiling_gap_start_s, "No ceiling frame from this second on ...")
      ->capture_default_str();
  command.add_option("--gap-seconds", o.ceiling_gap_seconds, "... for so long")->capture_default_str();
  command.add_option("--blocked-device", o.blocked_device, "A hand covers this device's view ...")
      ->capture_default_str();
  command.add_option("--blocked-start", o.blocked_start_s, "... from this second on ...")
      ->capture_default_str();
  command.add_option("--blocked-seconds", o.blocked_seconds, "... for so long")->capture_default_str();
}

}  // namespace

void add_sim(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<SimArguments>();
  CLI::App* command =
      app.add_subcommand("sim", "Simulate a furnished site: write a recording, or stream it over DDS");
  command->add_option("OUT", arguments->out, "Folder of the new recording; not with --live");
  command->add_flag("--live", arguments->live, "Stream in real time until Ctrl-C or --seconds");
  command->add_option("--domain", arguments->domain, "DDS domain of --live")
      ->check(command::in_range(0, 230))
      ->capture_default_str();
  command->add_option("--credentials", arguments->credentials,
                      "With --live: folder of deploy/credentials of a server, which may be everybody");
  command->add_option("--describe", arguments->describe,
                      "With --live: folder for site.json and the devices' files");
  command->add_option("--seed", arguments->options.seed, "Everything follows from it")
      ->check(command::any_seed())
      ->capture_default_str();
  CLI::Option* seconds = command
                             ->add_option("--seconds", arguments->options.seconds,
                                          "Length of the run; --live: an hour unless given")
                             ->capture_default_str();
  command->add_option("--threads", arguments->options.threads, "For ray casting")->capture_default_str();
  add_site_options(*command, *arguments);
  add_device_options(*command, *arguments);
  add_fault_options(*command, arguments->options);
  command->callback([arguments, seconds, &exit_code] {
    arguments->seconds_given = seconds->count() > 0;
    exit_code = run(*arguments);
  });
}

}  // namespace liloc::toolbox
