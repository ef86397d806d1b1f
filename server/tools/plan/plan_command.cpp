#include "server/tools/plan/plan_command.hpp"

#include <fmt/format.h>

#include <memory>

#include "common/command/checks.hpp"
#include "common/recording/files.hpp"
#include "common/recording/new_folder.hpp"
#include "common/recording/recording.hpp"
#include "common/recording/writer.hpp"
#include "server/tools/command.hpp"
#include "server/tools/plan/plan_drawing.hpp"
#include "server/tools/plan/plan_input.hpp"
#include "server/tools/plan/plan_report.hpp"

namespace liloc::toolbox {
namespace {

/// What the options say together. Errors name them.
Status check(const PlanArguments& arguments) {
  if (arguments.reference.empty() == arguments.floor_plan.empty())
    return fail("give either --reference, a scan, or --floor-plan, a drawing");
  if (arguments.lidars.has_value() == !arguments.evaluate.empty())
    return fail("give either --lidars, how many to place, or --evaluate, a site.json");
  if (arguments.scale_m && arguments.floor_plan.empty())
    return fail("--scale is of a --floor-plan; scans are in metres");
  return {};
}

/// The site to evaluate, or one of LiDARs that are placed.
Result<Site> site_of(const PlanArguments& arguments, const PlanInput& input, const plan::DeviceViews& devices) {
  if (input.site) return *input.site;
  plan::PlacementOptions options;
  options.lidars = *arguments.lidars;
  options.mounts.ceiling_z_m = input.ceiling_z_m;
  options.mounts.seed = arguments.seed;
  ProgressBar bar("placing");
  const auto mounts = plan::place_lidars(input.room, input.floor, devices, input.lidar, options,
                                         [&](double share) { bar.show(share); });
  if (!mounts) return tl::unexpected(mounts.error());
  Site site;
  for (std::size_t i = 0; i < mounts->size(); ++i)
    site.global_lidars.push_back(
        {fmt::format("ceiling{}", i), input.lidar.camera, arguments.rate_hz, (*mounts)[i].T_map_sensor()});
  return site;
}

std::vector<plan::HungLidar> hung(const Site& site, double range_m) {
  std::vector<plan::HungLidar> lidars;
  for (const GlobalLidar& lidar : site.global_lidars)
    lidars.push_back({lidar.id, lidar.camera, range_m, lidar.T_map_sensor});
  return lidars;
}

/// A planned site is used as it is read again from its file, so that `--evaluate` of it tells the same to the
/// digit.
Result<Site> written(const std::filesystem::path& file, Site site, bool planned) {
  if (const Status done = write_site(file, site); !done) return tl::unexpected(done.error());
  return planned ? read_site(file) : std::move(site);
}

Status write_all(const std::filesystem::path& folder, const PlanInput& input, const PlanFindings& findings) {
  if (const Status done = write_file(folder / "plan.json", plan_json(input, findings).dump(1) + "\n"); !done)
    return done;
  if (const Status done = write_file(folder / "coverage.svg", coverage_svg(input, findings)); !done)
    return done;
  return write_file(folder / "localizability.svg", localizability_svg(input, findings));
}

plan::DeviceViews look_around(const PlanInput& input) {
  ProgressBar bar("looking around");
  return plan::look_around(input.room, input.floor, input.device, [&](double share) { bar.show(share); });
}

int run(const PlanArguments& arguments) {
  if (const Status sound = check(arguments); !sound) return complain(sound.error(), kBadUsage);
  auto folder = NewFolder::beside(arguments.out);
  if (!folder) return complain({"--out: " + folder.error().message}, kBadUsage);
  const auto input = read_plan_input(arguments);
  if (!input) return complain(input.error(), kBadUsage);
  PlanFindings findings{{}, look_around(*input), {}, {}};
  auto site = site_of(arguments, *input, findings.devices);
  if (site) site = written(folder->path() / "site.json", std::move(*site), !input->site);
  if (!site) return complain(site.error(), kFailed);
  findings.site = std::move(*site);
  const auto lidars = hung(findings.site, arguments.lidar_range_m);
  findings.evaluation = plan::evaluate(input->room, input->floor, findings.devices, lidars);
  if (arguments.study) {
    ProgressBar bar("studying");
    findings.study = plan::study_placement(input->room, input->floor, findings.devices, lidars,
                                           [&](double share) { bar.show(share); });
  }
  Status done = write_all(folder->path(), *input, findings);
  if (done) done = folder->keep();
  if (!done) return complain(done.error(), kFailed);
  if (arguments.json)
    fmt::print("{}\n", plan_json(*input, findings).dump());
  else
    fmt::print("{}written to {}: plan.json, site.json, coverage.svg, localizability.svg\n",
               plan_table(*input, findings), arguments.out);
  return kDone;
}

void declare_room(CLI::App& command, PlanArguments& a) {
  command.add_option("--reference", a.reference, "Scan of the room in the map frame, z up, metres: PLY or PCD");
  command.add_option(
      "--floor-plan", a.floor_plan,
      "In place of a scan: walls drawn dark in a PNG, or the lines of an ASCII DXF; the outer wall "
      "without gaps");
  command
      .add_option("--scale", a.scale_m,
                  "Metres per pixel of the PNG, or per unit of the DXF, whatever unit it names")
      ->check(command::in_range(1e-4, 10.0));
  command.add_option("--height", a.height_m, "Metres from floor to ceiling, where the input does not show it")
      ->check(command::in_range(2.0, 30.0));
}

void declare_sensors(CLI::App& command, PlanArguments& a) {
  command.add_option(
      "--lidar-camera", a.lidar_camera,
      "Intrinsics of the LiDARs to place: a device.json, or a site.json, whose first one counts; else "
      "an L515's");
  command.add_option("--lidar-range", a.lidar_range_m, "Metres that a LiDAR sees")
      ->check(command::in_range(0.5, 30.0))
      ->capture_default_str();
  command.add_option("--rate", a.rate_hz, "Frames a second, written to site.json")
      ->check(command::in_range(0.1, 100.0))
      ->capture_default_str();
  command.add_option("--device", a.device, "Intrinsics of the devices: a device.json; else an L515's");
  command.add_option("--device-range", a.device_range_m, "Metres that a device sees")
      ->check(command::in_range(0.5, 30.0))
      ->capture_default_str();
  command
      .add_option("--device-height", a.device_heights_m,
                  "Heights of devices above the floor, in metres; 1 to 4")
      ->expected(1, 4)
      ->check(command::in_range(0.05, 3.0))
      ->capture_default_str();
}

}  // namespace

void add_plan(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<PlanArguments>();
  CLI::App* command =
      app.add_subcommand("plan", "Propose where ceiling LiDARs should hang, and predict what a site is worth");
  declare_room(*command, *arguments);
  command->add_option("--lidars", arguments->lidars, "How many to place")
      ->check(command::in_range(1, plan::kMostLidars));
  command->add_option("--evaluate", arguments->evaluate,
                      "In place of placing: predict for the LiDARs of a site.json");
  command->add_option("--out", arguments->out, "New folder for plan.json, site.json and pictures")->required();
  declare_sensors(*command, *arguments);
  command->add_flag("--study", arguments->study, "Also vary height, tilt and number of the LiDARs");
  command->add_option("--seed", arguments->seed, "Of the places that are tried")
      ->check(command::any_seed())
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "Print what plan.json holds");
  command->footer(
      "A device pose is localizable where a single request from it, answered on its own, would be verified. "
      "The "
      "prediction knows nothing of people, of what moves, and of a drawing's furniture. It was fitted to "
      "simulated sensors with little "
      "noise: noisier ones are verified far less often.");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace liloc::toolbox
