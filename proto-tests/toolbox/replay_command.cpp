#include <fmt/format.h>

#include <memory>

#include "common/command/checks.hpp"
#include "proto-tests/replay/processes.hpp"
#include "proto-tests/replay/replay.hpp"
#include "proto-tests/toolbox/commands.hpp"
#include "proto-tests/toolbox/converted_bag.hpp"

namespace liloc::toolbox {
namespace {

struct ReplayArguments {
  replay::ReplayOptions options;
  BagArguments bag;
};

int run(ReplayArguments arguments) {
  replay::catch_stop_signals();
  ConvertedBag bag;
  if (const auto taken = bag.take(arguments.options, arguments.bag); !taken)
    return complain({taken.error().message}, taken.error().unwritten ? kFailed : kBadUsage);
  const replay::ReplayOptions& options = arguments.options;
  ProgressBar bar(options.lockstep ? "replaying" : "replaying at recorded speed");
  auto report = replay::replay(options, [&](double share) { bar.show(share); });
  if (!report) return complain(report.error().error, report.error().bad_input ? kBadUsage : kFailed);
  bar.show(1);
  fmt::print("{}", replay::to_table(*report));
  fmt::print("written to {}\n", options.out.string());
  return kDone;
}

}  // namespace

void add_replay(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<ReplayArguments>();
  replay::ReplayOptions* options = &arguments->options;
  options->programs = replay::program_folder();
  CLI::App* command = app.add_subcommand(
      "replay", "Locate the devices of a recording, and judge the answers by its ground truth");
  command
      ->add_option("REC", options->recording,
                   "Folder of the recording, or a bag: its topics as for liloc convert")
      ->required();
  command->add_option("--out", options->out, "Folder for the traces and report.json")->required();
  command->add_flag("--lockstep", options->lockstep, "One process, no DDS, deterministic, as fast as it can");
  command->add_option("--seed", options->seed, "Of all randomness")
      ->check(command::any_seed())
      ->capture_default_str();
  command->add_option("--interval-ms", options->interval_ms, "Longest time between global registrations")
      ->capture_default_str();
  command
      ->add_option("--searching-interval-ms", options->searching_interval_ms,
                   "Shortest time between them while nothing is verified; 0: a quarter of --interval-ms")
      ->capture_default_str();
  command->add_option("--voxel", options->voxel_m, "Voxel size in metres")->capture_default_str();
  command
      ->add_option("--method", options->method,
                   "liloc, or for comparison: paper, dynamic-noopt, dynamic-nover, static-noopt")
      ->capture_default_str();
  command->add_option("--verify", options->verify, "tracks, paper or none; else the method's own");
  command->add_option("--risk", options->risk, "Of all verified answers, the share that may be wrong")
      ->capture_default_str();
  command->add_option("--icp", options->icp, "point or plane; else the method's own");
  command->add_option("--local", options->local, "Local registration: cloud, inertial or dead-reckoning")
      ->capture_default_str();
  command->add_option("--features", options->features, "Of points, for RANSAC: fpfh, or learned with --weights")
      ->capture_default_str();
  command->add_option("--weights", options->weights,
                      "Network of --features learned, from common/learned/convert_fcgf.py");
  command->add_option("--sampling", options->sampling, "Share of feature points that RANSAC uses")
      ->capture_default_str();
  command->add_option("--device", options->devices,
                      "Replay this device alone; of a bag ID=TOPIC; may be repeated");
  command->add_option("--save-answers", options->save_answers,
                      "DIR[:refused|wrong|all]: keep answers for liloc explain; the newest 200, 512 MiB");
  command->add_option("--codec", options->codec, "How clouds travel: draco, voxel or octree")
      ->capture_default_str();
  command->add_flag("--cold", options->cold, "Answer each request on its own: no prior, no history");
  command
      ->add_option(
          "--clock-ahead-ms", options->clock_ahead_ms,
          "The devices' clocks run so far ahead: what they sent is played that much earlier (not in lockstep)")
      ->check(command::in_range(-10'000.0, 10'000.0))
      ->capture_default_str();
  command->add_flag_callback(
      "--no-submap", [options] { options->submap = false; },
      "Requests carry a frame alone, without what was seen before");
  add_bag_options(*command, arguments->bag);
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace liloc::toolbox
