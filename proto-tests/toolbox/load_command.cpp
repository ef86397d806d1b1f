#include <fmt/format.h>

#include <memory>

#include "common/command/checks.hpp"
#include "proto-tests/load/load.hpp"
#include "proto-tests/replay/processes.hpp"
#include "proto-tests/toolbox/commands.hpp"

namespace liloc::toolbox {
namespace {

struct LoadArguments {
  load::LoadOptions options;
  std::string ramp, kind = "office";
};

Result<load::LoadOptions> checked_options(const LoadArguments& arguments) {
  load::LoadOptions options = arguments.options;
  options.programs = replay::program_folder();
  const auto kind = sim::site_kind_of(arguments.kind);
  if (!kind) return tl::unexpected(kind.error());
  options.kind = *kind;
  if (!arguments.ramp.empty()) {
    const auto counts = load::ramp_of(arguments.ramp);
    if (!counts) return tl::unexpected(counts.error());
    options.clients = *counts;
  }
  if (const Status ok = options.validated(); !ok) return tl::unexpected(ok.error());
  return options;
}

Result<std::vector<load::LoadReport>> run_all(const load::LoadOptions& options) {
  Result<load::Script> script = [&] {
    ProgressBar bar("computing requests");
    return load::make_script(options, [&](double share) { bar.show(share); });
  }();
  if (!script) return tl::unexpected(script.error());
  std::vector<load::LoadReport> reports;
  for (const int clients : options.clients) {
    const std::string label = fmt::format("{} clients", clients);
    ProgressBar bar(label);
    auto report = load::run_load(*script, options, clients, [&](double share) { bar.show(share); });
    if (!report) return tl::unexpected(report.error());
    reports.push_back(std::move(*report));
    if (const Status written = load::write_reports(options, reports); !written)
      return tl::unexpected(written.error());
  }
  return reports;
}

int run(const LoadArguments& arguments) {
  replay::catch_stop_signals();
  const auto options = checked_options(arguments);
  if (!options) return complain(options.error(), kBadUsage);
  const auto reports = run_all(*options);
  if (!reports) return complain(reports.error(), kFailed);
  fmt::print("{}written to {}\n", load::to_table(*reports), options->out.string());
  return std::ranges::all_of(*reports, &load::LoadReport::valid) ? kDone : kFailed;
}

void add_device_options(CLI::App& command, load::LoadOptions& o) {
  command.add_option("--clients", o.clients, "How many at once; several counts are several runs")
      ->capture_default_str();
  command.add_option("--seconds", o.seconds, "Measured, after a warm-up of 6 s and 50 ms a client")
      ->capture_default_str();
  command.add_option("--interval-ms", o.interval_ms, "Between a device's requests")->capture_default_str();
  command.add_option("--processes", o.processes, "That play the devices")->capture_default_str();
  command.add_option("--lost-share", o.lost_share, "Of the devices: lose their odometry, all at one moment")
      ->capture_default_str();
  command
      .add_option("--kidnap", o.kidnap_s,
                  "Mean seconds until a device is carried elsewhere unnoticed; 0: never")
      ->capture_default_str();
  command.add_option("--churn", o.churn_s, "Mean seconds until a device goes and another comes; 0: they stay")
      ->capture_default_str();
  command.add_option("--frame-loss", o.frame_loss, "Share of the devices' frames")->capture_default_str();
  command.add_option("--clock-offset", o.clock_offset_s, "Devices' clocks are off by up to so many seconds")
      ->capture_default_str();
  command.add_option("--codec", o.codec, "How their clouds travel: draco, voxel or octree")
      ->capture_default_str();
  command.add_flag("--in-phase", o.in_phase, "All devices start at one moment");
}

void add_site_options(CLI::App& command, LoadArguments& arguments) {
  load::LoadOptions& o = arguments.options;
  command.add_option("--seed", o.seed, "Everything follows from it")
      ->check(command::any_seed())
      ->capture_default_str();
  command.add_option("--kind", arguments.kind, "Of the site: office, corridor, symmetric or area")
      ->capture_default_str();
  command.add_option("--people", o.people, "Walking about")->capture_default_str();
  command.add_option("--lidars", o.lidars, "Ceiling LiDARs")->capture_default_str();
  command.add_option("--lidar-rate", o.lidar_rate_hz, "Their frames per second")->capture_default_str();
  command.add_option("--paths", o.paths, "Simulated ways, which the devices share")->capture_default_str();
  command.add_option("--path-seconds", o.path_s, "Length of a way; it is walked to and fro")
      ->capture_default_str();
}

}  // namespace

void add_load(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<LoadArguments>();
  load::LoadOptions& o = arguments->options;
  CLI::App* command = app.add_subcommand(
      "load", "How many devices a server holds: simulated ones ask it in real time, whatever it answers");
  command->add_option("OUT", o.out, "Folder for load.json, load.svg, site.json and server.log")->required();
  command->add_option("--ramp", arguments->ramp, "FIRST:LAST: a run each with 1, 2, 5, 10, 20 ... clients");
  add_device_options(*command, o);
  add_site_options(*command, *arguments);
  command
      ->add_option("--domain", o.domain,
                   "DDS domain of a server that runs already, with OUT/site.json; -1: start one")
      ->capture_default_str();
  command->add_option("--server", o.server, "Host of that server; this one unless given");
  command->add_option("--credentials", o.credentials,
                      "Folder of deploy/credentials of a server, which may be everybody: for both sides");
  command->add_option("--server-option", o.server_options,
                      "For the liloc-server that is started; may be repeated: --server-option=--workers=2");
  command->add_option("--freeze", o.freeze_s, "Stop the server for so many seconds in the middle of a run")
      ->capture_default_str();
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace liloc::toolbox
