#include <fmt/format.h>

#include <memory>

#include "common/base/stop_signals.hpp"
#include "common/command/checks.hpp"
#include "server/tools/command.hpp"
#include "server/tools/recorder.hpp"

namespace liloc::toolbox {
namespace {

using namespace std::chrono_literals;

struct RecordArguments {
  std::string out, site;
  std::vector<std::string> devices;
  /// The third seat of a host: ceiling LiDARs, devices and simulations look there, too, and it leaves the
  /// server its own.
  wire::DomainOptions seat{.role = wire::Role::standby};
  double seconds = 0;
};

struct Sensors {
  Site site;
  std::vector<DeviceInfo> devices;
};

Result<Sensors> read_sensors(const RecordArguments& arguments) {
  auto site = read_site(arguments.site);
  if (!site) return tl::unexpected(site.error());
  Sensors sensors{std::move(*site), {}};
  for (const std::string& file : arguments.devices) {
    auto device = read_device(file);
    if (!device) return tl::unexpected(device.error());
    sensors.devices.push_back(std::move(*device));
  }
  return sensors;
}

/// Until a signal, the end of the time, or a file that cannot be written.
void wait(const RecordArguments& arguments, const StopSignals& signals, const Recorder& recorder) {
  const Stopwatch watch;
  while (signals.within(50ms) == 0 && recorder.trouble() &&
         (arguments.seconds == 0 || watch.elapsed_ms() < 1e3 * arguments.seconds)) {
  }
}

std::string line_of(const std::string& id, const Recorded& of) {
  std::string line = fmt::format("{}: {} frames", id, of.frames);
  if (of.samples > 0) line += fmt::format(", {} IMU samples", of.samples);
  if (of.left_out > 0)
    line += fmt::format(", {} frames left out: they came faster than they were written", of.left_out);
  if (of.refused > 0) line += fmt::format(", {} refused, the last: {}", of.refused, of.last_refusal);
  return line + "\n";
}

int tell(const RecordArguments& arguments, const Sensors& sensors, const Recorder& recorder,
         std::uint64_t samples_lost) {
  const auto recorded = recorder.recorded();
  for (const auto& [id, of] : recorded) fmt::print("{}", line_of(id, of));
  if (samples_lost > 0) fmt::print("{} samples were lost on the way; see liloc doctor\n", samples_lost);
  fmt::print("written to {}\n", arguments.out);
  std::size_t ceiling = 0;
  for (const GlobalLidar& lidar : sensors.site.global_lidars) ceiling += recorded.at(lidar.id).frames;
  if (ceiling > 0) return kDone;
  return complain(
      {fmt::format("record: no ceiling LiDAR was heard on domain {}; do they stream there? liloc doctor looks",
                   arguments.seat.domain)},
      kFailed);
}

int run(const RecordArguments& arguments) {
  const StopSignals signals;
  const auto sensors = read_sensors(arguments);
  if (!sensors) return complain(sensors.error(), kBadUsage);
  if (const Status fine = Recorder::check(sensors->site, sensors->devices, arguments.out); !fine)
    return complain(fine.error(), kBadUsage);
  const auto participant = wire::Participant::create(arguments.seat);
  if (!participant) return complain(participant.error(), kFailed);
  auto dispatcher = wire::Dispatcher::create(*participant);
  if (!dispatcher) return complain(dispatcher.error(), kFailed);
  const auto recorder = Recorder::create(**dispatcher, sensors->site, sensors->devices, arguments.out);
  if (!recorder) return complain(recorder.error(), kFailed);
  (*dispatcher)->start();
  fmt::print("recording on domain {}; Ctrl-C ends it\n", arguments.seat.domain);
  std::fflush(stdout);
  wait(arguments, signals, **recorder);
  const std::uint64_t samples_lost = (*dispatcher)->samples_lost();
  (*dispatcher)->stop();
  if (const Status finished = (*recorder)->finish(); !finished) return complain(finished.error(), kFailed);
  return tell(arguments, *sensors, **recorder, samples_lost);
}

}  // namespace

void add_record(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<RecordArguments>();
  CLI::App* command =
      app.add_subcommand("record", "Write the live streams of ceiling LiDARs and devices as a recording");
  command->add_option("OUT", arguments->out, "Folder of the recording; must be new")->required();
  command->add_option("--site", arguments->site, "site.json of the ceiling LiDARs")->required();
  command
      ->add_option("--device", arguments->devices,
                   "device.json of a device whose depth and IMU are to be recorded, too; may be repeated")
      ->allow_extra_args(false);
  command->add_option("--domain", arguments->seat.domain, "DDS domain")
      ->check(command::in_range(0, 230))
      ->capture_default_str();
  command->add_option("--interface", arguments->seat.interface, "Network interface: name, address or auto")
      ->capture_default_str();
  command->add_option("--credentials", arguments->seat.credentials,
                      "Folder of deploy/credentials of a server, which may hear everybody");
  command->add_option("--seconds", arguments->seconds, "How long; 0: until Ctrl-C")
      ->check(command::in_range(0.0, 1e6))
      ->capture_default_str();
  command->footer("On a host where a standby server runs its place is taken: record on another one.");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace liloc::toolbox
