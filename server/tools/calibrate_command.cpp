#include <fmt/format.h>

#include <memory>

#include "common/command/checks.hpp"
#include "common/recording/recording.hpp"
#include "server/global_cloud/background.hpp"
#include "server/survey/calibration.hpp"
#include "server/tools/calibration_report.hpp"
#include "server/tools/cloud_file.hpp"
#include "server/tools/command.hpp"

namespace liloc::toolbox {
namespace {

struct CalibrateArguments {
  std::string recording, site, reference, out, initial = "site";
  std::vector<std::tuple<std::string, double, double, double, double>> near;  ///< id, x, y, z (m), yaw (deg)
  std::size_t most_frames = 120;
  std::uint64_t seed = 1;
  bool json = false;
};

constexpr std::size_t kFewestFrames = 5;  // by hand
constexpr int kMostFrames = 120;          // in a pixel's mean: what remains of 1 cm of noise is a millimetre
constexpr double kFarthest = 1000;        // m or degrees, of a rough start: far beyond any site

/// The mean of what stands still before a LiDAR.
Result<DepthImage> standing(const LidarRecording& lidar, const Camera& camera, std::size_t most_frames,
                            const std::function<void()>& on_frame) {
  if (lidar.depth.size() < kFewestFrames)
    return fail("{}: {} frames, of at least {}; record for some seconds", lidar.info.id, lidar.depth.size(),
                kFewestFrames);
  BackgroundOptions options;
  options.most_averaged = kMostFrames;
  Background background(camera, options);
  for (std::size_t i = 0; i < std::min(most_frames, lidar.depth.size()); ++i) {
    const auto image = read_depth(lidar.depth[i], camera);
    if (!image) return tl::unexpected(image.error());
    (void)background.learn(*image);
    on_frame();
  }
  return background.surfaces();
}

/// The recording's LiDARs with the guesses of `site`.
Result<std::vector<survey::LidarScan>> scans_of(const Recording& recording, const Site& site,
                                                std::size_t most_frames) {
  std::vector<survey::LidarScan> scans;
  std::size_t all = 0, done = 0;
  for (const LidarRecording& lidar : recording.lidars) all += std::min(most_frames, lidar.depth.size());
  ProgressBar bar("reading");
  for (const GlobalLidar& lidar : site.global_lidars) {
    const auto recorded =
        std::ranges::find(recording.lidars, lidar.id, [](const LidarRecording& r) { return r.info.id; });
    if (recorded == recording.lidars.end())
      return fail("{} is not in the recording {}; record it, or take it out of the site", lidar.id,
                  recording.root.string());
    auto surfaces = standing(*recorded, lidar.camera, most_frames, [&] {
      bar.show(static_cast<double>(++done) / static_cast<double>(std::max<std::size_t>(all, 1)));
    });
    if (!surfaces) return tl::unexpected(surfaces.error());
    auto scan = survey::make_scan(lidar, std::move(*surfaces), survey::kVoxel_m);
    if (!scan) return tl::unexpected(scan.error());
    scans.push_back(std::move(*scan));
  }
  return scans;
}

Result<std::optional<survey::Reference>> reference_of(const std::string& file) {
  if (file.empty()) return std::nullopt;
  const auto cloud = read_map_scan(file);
  if (!cloud) return tl::unexpected(cloud.error());
  auto reference = survey::Reference::create(*cloud, survey::kVoxel_m);
  if (!reference) return fail("{}: {}", file, reference.error().message);
  return std::move(*reference);
}

/// A ceiling LiDAR that looks straight down, the top of its image towards `yaw_deg`.
Pose looking_down(double x_m, double y_m, double z_m, double yaw_deg) {
  Pose T = Pose::Identity();
  T.linear() = (Eigen::AngleAxisd(radians(yaw_deg - 90), Eigen::Vector3d::UnitZ()) *
                Eigen::AngleAxisd(radians(180), Eigen::Vector3d::UnitX()))
                   .toRotationMatrix();
  T.translation() = Eigen::Vector3d(x_m, y_m, z_m);
  return T;
}

/// Puts rough starts into the site; which LiDARs are still to be searched for.
Result<survey::CalibrationOptions> starts_of(const CalibrateArguments& arguments, Site* site) {
  survey::CalibrationOptions options;
  options.seed = arguments.seed;
  options.search.assign(site->global_lidars.size(), arguments.initial == "none");
  for (const auto& [id, x, y, z, yaw] : arguments.near) {
    const auto lidar = std::ranges::find(site->global_lidars, id, &GlobalLidar::id);
    if (lidar == site->global_lidars.end()) return fail("--near {}: the site has no such LiDAR", id);
    for (const double value : {x, y, z, yaw})
      if (!(std::abs(value) <= kFarthest))
        return fail("--near {}: is '{}'; give metres and degrees, -{}..{}", id, value, kFarthest, kFarthest);
    lidar->T_map_sensor = looking_down(x, y, z, yaw);
    options.search[static_cast<std::size_t>(lidar - site->global_lidars.begin())] = false;
  }
  return options;
}

int run(const CalibrateArguments& arguments) {
  const auto recording = open_recording(arguments.recording);
  if (!recording) return complain(recording.error(), kBadUsage);
  auto site = read_site(arguments.site);
  if (!site) return complain(site.error(), kBadUsage);
  const auto options = starts_of(arguments, &*site);
  if (!options) return complain(options.error(), kBadUsage);
  const auto reference = reference_of(arguments.reference);
  if (!reference) return complain(reference.error(), kBadUsage);
  const auto scans = scans_of(*recording, *site, arguments.most_frames);
  if (!scans) return complain(scans.error(), kFailed);
  const auto results = survey::calibrate(*scans, *reference ? &**reference : nullptr, *options);
  if (!results) return complain(results.error(), kFailed);
  print_calibration(*scans, *results, arguments.json);
  if (!std::ranges::all_of(*results, &survey::CalibratedLidar::trusted))
    return complain({fmt::format("not every LiDAR is trusted; {} is not written", arguments.out)}, kFailed);
  if (const Status written = write_calibrated(arguments.site, arguments.out, *results); !written)
    return complain(written.error(), kFailed);
  return kDone;
}

}  // namespace

void add_calibrate(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<CalibrateArguments>();
  CLI::App* command = app.add_subcommand("calibrate", "Find where the ceiling LiDARs of a site hang");
  command->add_option("REC", arguments->recording, "Recording with frames of every LiDAR")->required();
  command->add_option("--site", arguments->site, "Its site.json: LiDARs, intrinsics and guesses")->required();
  command
      ->add_option("--out", arguments->out,
                   "The site with the places found; written where every LiDAR is trusted")
      ->required();
  command->add_option(
      "--reference", arguments->reference,
      "Scan of the room in the map frame, PLY or PCD; without it LiDARs are placed by their overlap "
      "and the first stays");
  command->add_option("--initial", arguments->initial, "site: start at the site's places; none: search")
      ->check(command::one_of({"site", "none"}))
      ->capture_default_str();
  command->add_option("--near", arguments->near,
                      "ID X Y Z YAW: rough start of a LiDAR that looks down, in m and deg; may be repeated");
  command->add_option("--frames", arguments->most_frames, "Frames of each LiDAR to average")
      ->check(command::in_range(5, kMostFrames))
      ->capture_default_str();
  command->add_option("--seed", arguments->seed, "Of all randomness")
      ->check(command::any_seed())
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "Print JSON");
  command->callback([arguments, &exit_code] { exit_code = run(*arguments); });
}

}  // namespace liloc::toolbox
