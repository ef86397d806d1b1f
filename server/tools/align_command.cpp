#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "common/command/checks.hpp"
#include "common/learned/describer.hpp"
#include "common/registration/spot/align.hpp"
#include "server/tools/cloud_file.hpp"
#include "server/tools/command.hpp"

namespace liloc::toolbox {
namespace {

struct AlignArguments {
  std::string source, target;
  AlignOptions options;
  std::string features = "fpfh", weights;
  bool json = false;
};

void print_text(const AlignResult& result, double latency_ms) {
  const Eigen::Matrix4d T = result.T_target_source.matrix();
  for (int row = 0; row < 4; ++row)
    fmt::print("{: .9f} {: .9f} {: .9f} {: .9f}\n", T(row, 0), T(row, 1), T(row, 2), T(row, 3));
  fmt::print("fitness: {:.4f}\nrmse: {:.4f} m\nconfidence: {:.4f}\ntrusted: {}\nlatency: {:.1f} ms\n",
             result.fitness, result.rmse_m, result.confidence, result.trusted ? "yes" : "no", latency_ms);
}

void print_json(const AlignResult& result, double latency_ms) {
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (int row = 0; row < 4; ++row) {
    const Eigen::RowVector4d values = result.T_target_source.matrix().row(row);
    rows.push_back({values[0], values[1], values[2], values[3]});
  }
  const nlohmann::ordered_json json{{"T_target_source", rows},   {"fitness", result.fitness},
                                    {"rmse_m", result.rmse_m},   {"confidence", result.confidence},
                                    {"trusted", result.trusted}, {"found", result.found},
                                    {"latency_ms", latency_ms}};
  fmt::print("{}\n", json.dump());
}

/// The same pose between the files' own coordinates.
Pose between_files(const Pose& T_target_source, const PlacedCloud& source, const PlacedCloud& target) {
  return Eigen::Translation3d(target.origin) * T_target_source * Eigen::Translation3d(-source.origin);
}

int run(AlignArguments& arguments) {
  auto describer = learned::describer_from(arguments.features, arguments.weights, arguments.options.threads);
  if (!describer) return complain(describer.error(), kBadUsage);
  arguments.options.describer = std::move(*describer);
  const auto source = read_placed_cloud(arguments.source);
  if (!source) return complain(source.error(), kBadUsage);
  const auto target = read_placed_cloud(arguments.target);
  if (!target) return complain(target.error(), kBadUsage);
  const Stopwatch watch;
  auto result = align_clouds(source->cloud, target->cloud, arguments.options);
  if (!result)
    return complain({fmt::format("{} into {}: {}", arguments.source, arguments.target, result.error().message)},
                    kFailed);
  if (result->found) result->T_target_source = between_files(result->T_target_source, *source, *target);
  (arguments.json ? print_json : print_text)(*result, watch.elapsed_ms());
  if (result->found) return kDone;
  return complain(
      {fmt::format("{} into {}: nothing fits, the matrix says nothing; do they show the same place?",
                   arguments.source, arguments.target)},
      kFailed);
}

}  // namespace

void add_align(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<AlignArguments>();
  CLI::App* command =
      app.add_subcommand("align", "Print the 4x4 matrix that maps SOURCE into TARGET, and whether to trust it");
  command->add_option("SOURCE", arguments->source, "PCD or PLY file")->required();
  command->add_option("TARGET", arguments->target, "PCD or PLY file")->required();
  command->add_option("--voxel", arguments->options.voxel_size_m, "Voxel size in metres")
      ->check(command::in_range(0.005, 1.0))
      ->capture_default_str();
  command->add_option("--seed", arguments->options.seed, "Of all randomness")
      ->check(command::any_seed())
      ->capture_default_str();
  command->add_option("--threads", arguments->options.threads, "Threads to use")
      ->check(command::in_range(1, 256))
      ->capture_default_str();
  command
      ->add_option("--risk", arguments->options.risk,
                   "Trust a result whose probability of being off by over 0.2 m is at most this")
      ->check(command::in_range(1e-6, 0.999))
      ->capture_default_str();
  command
      ->add_option("--features", arguments->features,
                   "Of points: fpfh, or learned with --weights; confidence was fitted with fpfh")
      ->check(command::one_of({"fpfh", "learned"}))
      ->capture_default_str();
  command->add_option("--weights", arguments->weights,
                      "Network of --features learned, from common/learned/convert_fcgf.py");
  command->add_flag("--gravity", arguments->options.gravity,
                    "Both clouds have z up: search x, y, z and yaw alone");
  command->add_flag("--json", arguments->json, "Print JSON");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace liloc::toolbox
