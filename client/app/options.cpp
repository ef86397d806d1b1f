#include "client/app/options.hpp"

#include <CLI/CLI.hpp>
#include <map>

#include "common/recording/recording.hpp"

namespace liloc {
namespace {

struct Raw {
  std::string local = "cloud", log_level = "info";
  std::vector<double> imu_translation, imu_rotation;
};

void declare_device(CLI::App& app, DaemonOptions& options, Raw& raw) {
  auto* device = app.add_option_group("device");
  device->add_option("--device", options.device_file, "device.json: intrinsics, IMU mounting, still time");
  device
      ->add_option("--depth-scale", options.client.camera.depth_scale_m,
                   "Metres per unit of a 16-bit depth image, without --device")
      ->capture_default_str();
  device
      ->add_option("--imu-translation", raw.imu_translation,
                   "T_imu_sensor of a device with an IMU, without --device: x y z in m")
      ->expected(3);
  device->add_option("--imu-rotation", raw.imu_rotation, "The same: quaternion x y z w")->expected(4);
  device
      ->add_option("--still-seconds", options.client.still_seconds,
                   "The device stands still for so long at the start, without --device")
      ->capture_default_str();
  device->add_flag("--ros", options.ros, "Find the drivers of this host; publish pose, odometry and tf");
}

void declare(CLI::App& app, DaemonOptions& options, Raw& raw) {
  auto& c = options.client;
  app.set_version_flag("--version", LILOC_VERSION);
  app.set_config("--config", "", "Read options from this file (TOML: name = value)");
  app.add_option("--id", c.id, "Name of the device: its topics are rt/<id>/...")->required();
  app.add_option("--domain", c.domain, "DDS domain, 0..230")->check(CLI::Range(0, 230))->capture_default_str();
  app.add_option("--interface", c.network_interface, "Network interface: name, address or auto")
      ->capture_default_str();
  app.add_option("--peer", c.peers, "Host of the server; default: this one");
  declare_device(app, options, raw);

  auto* method = app.add_option_group("localization");
  method->add_option("--interval-ms", c.interval_ms, "Upper bound between global registrations")
      ->check(CLI::Range(50, 60'000))
      ->capture_default_str();
  method->add_option("--reply-timeout-ms", c.reply_timeout_ms, "A request older than so counts as unanswered")
      ->check(CLI::Range(100, 600'000))
      ->capture_default_str();
  method->add_option("--voxel", c.voxel_size_m, "Voxel size of the cloud that is sent, m")
      ->capture_default_str();
  method->add_option("--local", raw.local, "Local registration: cloud, inertial or dead-reckoning")
      ->capture_default_str();
  method->add_flag("--cold", c.cold, "Each request is answered on its own");
  method->add_option("--seed", c.seed, "Of all randomness")->capture_default_str();

  app.add_option("--trace", c.trace_folder, "Write online.tum, trajectory.tum, spots.csv and local.csv here");
  app.add_option("--log-level", raw.log_level, "debug, info, warning or error")->capture_default_str();
}

Status settle(DaemonOptions& options, const Raw& raw) {
  static const std::map<std::string, client::Local> methods{{"cloud", client::Local::cloud},
                                                            {"inertial", client::Local::inertial},
                                                            {"dead-reckoning", client::Local::dead_reckoning}};
  static const std::map<std::string, log::Level> levels{{"debug", log::Level::debug},
                                                        {"info", log::Level::info},
                                                        {"warning", log::Level::warning},
                                                        {"error", log::Level::error}};
  const auto method = methods.find(raw.local);
  if (method == methods.end())
    return fail("--local is '{}'; must be cloud, inertial or dead-reckoning", raw.local);
  const auto level = levels.find(raw.log_level);
  if (level == levels.end())
    return fail("--log-level is '{}'; must be debug, info, warning or error", raw.log_level);
  options.client.local = method->second;
  options.log_level = level->second;
  if (raw.imu_translation.empty() != raw.imu_rotation.empty())
    return fail("--imu-translation and --imu-rotation go together: give both or neither");
  if (raw.imu_translation.empty()) return {};
  if (!options.device_file.empty())
    return fail("--imu-... and --device contradict each other: give one of them");
  auto& T = options.client.T_imu_sensor.emplace();
  std::copy_n(raw.imu_translation.begin(), 3, T.translation_m.begin());
  std::copy_n(raw.imu_rotation.begin(), 4, T.rotation_xyzw.begin());
  return {};
}

client::Pose to_public(const Pose& T) {
  const Eigen::Vector3d t = T.translation();
  const Eigen::Quaterniond q(T.linear());
  return {{t.x(), t.y(), t.z()}, {q.x(), q.y(), q.z(), q.w()}};
}

}  // namespace

Result<DaemonOptions> parse_arguments(int argc, const char* const* argv, int& exit_code) {
  DaemonOptions options;
  Raw raw;
  CLI::App app(
      "LiLoc client: localizes a device from its depth frames (rt/<id>/depth/image_rect_raw) and, where there "
      "is "
      "one, its IMU (rt/<id>/imu).",
      "liloc-client");
  declare(app, options, raw);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    exit_code = app.exit(error) == 0 ? 0 : 2;  // prints the help, or what was wrong
    return fail("");                           // CLI11 has said it
  }
  if (const Status ok = settle(options, raw); !ok) {
    exit_code = 2;
    return tl::unexpected(ok.error());
  }
  return options;
}

Status read_device_file(DaemonOptions& options) {
  const auto device = read_device(options.device_file);
  if (!device) return tl::unexpected(device.error());
  if (device->id != options.client.id)
    log::info("{} describes {}; used for {}", options.device_file, device->id, options.client.id);
  const Camera& c = device->camera;
  options.client.camera = {c.width, c.height, c.fx, c.fy, c.cx, c.cy, c.depth_scale_m};
  options.client.still_seconds = device->still_seconds;
  if (device->T_imu_sensor) options.client.T_imu_sensor = to_public(*device->T_imu_sensor);
  return {};
}

}  // namespace liloc
