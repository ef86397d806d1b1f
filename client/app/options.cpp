#include "client/app/options.hpp"

#include <CLI/CLI.hpp>

#include "client/app/given_options.hpp"
#include "common/command/checks.hpp"
#include "common/command/program_options.hpp"
#include "common/recording/recording.hpp"

namespace liloc {
namespace {

using command::in_range;

void declare_device(CLI::App& app, DaemonOptions& options, GivenOptions& given) {
  auto* device = app.add_option_group("device");
  device->add_option("--device", options.device_file, "device.json: intrinsics, IMU mounting, still time");
  device
      ->add_option("--depth-scale", options.client.camera.depth_scale_m,
                   "Metres per unit of a 16-bit depth image, without --device")
      ->check(in_range(1e-6, 1.0))
      ->capture_default_str();
  device
      ->add_option("--imu-translation", given.imu_translation,
                   "T_imu_sensor of a device with an IMU, without --device: x y z in m")
      ->expected(3)
      ->check(command::finite());
  device->add_option("--imu-rotation", given.imu_rotation, "The same: quaternion x y z w")
      ->expected(4)
      ->check(command::finite());
  device
      ->add_option("--still-seconds", options.client.still_seconds,
                   "The device stands still for so long at the start, without --device")
      ->check(in_range(0.0, 600.0))
      ->capture_default_str();
}

void declare_topics(CLI::App& app, GivenOptions& given) {
  auto* topics = app.add_option_group("input", "ROS names of the sensors' topics");
  topics->add_option("--depth-topic", given.depth, "Image, 16UC1 or 32FC1; default: <id>/depth/image_rect_raw");
  topics->add_option("--camera-info-topic", given.camera_info,
                     "CameraInfo, the intrinsics without --device; default: <id>/depth/camera_info");
  topics->add_option("--points-topic", given.points,
                     "PointCloud2 in the sensor's frame, in place of the image");
  topics
      ->add_option("--points-view", given.points_view,
                   "Part of the cloud that is used, without --device: columns, rows, degrees across and down, "
                   "with about one pixel per point")
      ->expected(4)
      ->check(command::finite())
      ->capture_default_str();
  topics->add_option("--imu-topic", given.imu, "Imu; default: <id>/imu");
  topics->add_option("--odometry-topic", given.odometry,
                     "Odometry that others keep: the client then does the global part alone");
  topics
      ->add_option("--base-translation", given.base_translation,
                   "T_base_sensor: the depth sensor on what that odometry moves, x y z in m")
      ->expected(3)
      ->check(command::finite());
  topics->add_option("--base-rotation", given.base_rotation, "The same: quaternion x y z w")
      ->expected(4)
      ->check(command::finite());
}

void declare_ros(CLI::App& app, RosOptions& ros, GivenOptions& given) {
  auto* group = app.add_option_group("ros", "What is told to ROS");
  group->add_flag("--ros", ros.enabled,
                  "Find the drivers of this host; publish pose, odometry, tf and diagnostics");
  group->add_option("--pose-topic", given.pose, "PoseWithCovarianceStamped; default: <id>/pose");
  group->add_option("--odom-topic", given.odom, "Odometry; default: <id>/odom");
  group->add_option("--diagnostics-topic", given.diagnostics, "DiagnosticArray; default: diagnostics");
  group->add_option("--map-frame", given.map_frame, "Default: map");
  group->add_option("--odom-frame", given.odom_frame,
                    "Default: <id>/odom; with --odometry-topic odom, the frame of those messages");
  group->add_option("--sensor-frame", given.sensor_frame, "Default: <id>/depth_optical_frame");
  group
      ->add_option("--tf-ahead-ms", ros.tf_ahead_ms,
                   "Stamp map -> odom so far ahead, that it holds until the next frame")
      ->check(in_range(0.0, 2000.0))
      ->capture_default_str();
  group
      ->add_option("--tf-max-speed", ros.tf_max_speed_m_s,
                   "Corrections move map -> odom by this in m/s; 0: at once")
      ->check(in_range(0.0, 100.0))
      ->capture_default_str();
  group->add_option("--tf-max-turn", ros.tf_max_turn_deg_s, "The same in degrees per second")
      ->check(in_range(0.0, 3600.0))
      ->capture_default_str();
}

void declare_network(CLI::App& app, client::Options& c) {
  app.add_option("--id", c.id, "Name of the device: its topics are rt/<id>/...")
      ->required()
      ->check(command::an_id());
  app.add_option("--domain", c.domain, "DDS domain")->check(in_range(0, 230))->capture_default_str();
  app.add_option("--interface", c.network_interface, "Network interface: name, address or auto")
      ->capture_default_str();
  app.add_option("--peer", c.peers, "Host of the server, and of its standby; default: this one");
  app.add_option(
      "--credentials", c.credentials,
      "Folder of deploy/credentials: encrypted, and only with those who have theirs of the same keystore");
}

void declare_method(CLI::App& app, client::Options& c, GivenOptions& given) {
  auto* method = app.add_option_group("localization");
  method->add_option("--interval-ms", c.interval_ms, "Upper bound between global registrations")
      ->check(in_range(50, 60'000))
      ->capture_default_str();
  method
      ->add_option(
          "--searching-interval-ms", c.searching_interval_ms,
          "Lower bound while nothing is verified: an answer brings the next request forward; 0: a quarter "
          "of --interval-ms")
      ->check(in_range(0, 60'000))
      ->capture_default_str();
  method->add_option("--lost-sd-m", c.lost_sd_m, "Standard deviation of the pose beyond which it is lost")
      ->check(in_range(0.01, 100.0))
      ->capture_default_str();
  method->add_option("--lost-sd-deg", c.lost_sd_deg, "The same in degrees")
      ->check(in_range(0.1, 180.0))
      ->capture_default_str();
  method->add_option("--reply-timeout-ms", c.reply_timeout_ms, "A request older than so counts as unanswered")
      ->check(in_range(100, 600'000))
      ->capture_default_str();
  method->add_option("--voxel", c.voxel_size_m, "Voxel size of the cloud that is sent, m")
      ->check(in_range(0.01, 0.5))
      ->capture_default_str();
  method->add_option("--local", given.local, "Local registration: cloud, inertial or dead-reckoning")
      ->check(command::one_of({"cloud", "inertial", "dead-reckoning"}))
      ->capture_default_str();
  method
      ->add_option("--cpu-share", c.cpu_share,
                   "Of one core for the registration; frames are left out to keep it")
      ->check(in_range(0.02, 1.0))
      ->capture_default_str();
  method->add_flag_callback(
      "--no-submap", [&c] { c.submap = false; }, "Send the frame alone, without what stands around");
  method
      ->add_option("--request-bytes", c.request_bytes,
                   "Most, of a request's clouds: the surroundings give way first, then the frame is thinned")
      ->check(in_range(2000, 60'000))
      ->capture_default_str();
  method
      ->add_option(
          "--codec", given.codec,
          "How clouds travel: draco, voxel (for thin links) or octree; a server that does not read it gets "
          "another that it does")
      ->check(command::one_of({"draco", "voxel", "octree"}))
      ->capture_default_str();
  method->add_flag("--cold", c.cold, "Each request is answered on its own");
  method->add_option("--seed", c.seed, "Of all randomness")->check(command::any_seed())->capture_default_str();
}

void declare(CLI::App& app, DaemonOptions& options, GivenOptions& given) {
  client::Options& c = options.client;
  app.set_version_flag("--version", LILOC_VERSION);
  declare_network(app, c);
  declare_device(app, options, given);
  declare_topics(app, given);
  declare_ros(app, options.ros, given);
  declare_method(app, c, given);
  app.add_option("--trace", c.trace_folder, "Write online.tum, trajectory.tum, spots.csv and local.csv here");
  app.add_option("--log-level", given.log_level, "debug, info, warning or error")
      ->check(command::one_of({"debug", "info", "warning", "error"}))
      ->capture_default_str();
}

client::Pose to_public(const Pose& T) {
  const Eigen::Vector3d t = T.translation();
  const Eigen::Quaterniond q(T.linear());
  return {{t.x(), t.y(), t.z()}, {q.x(), q.y(), q.z(), q.w()}};
}

}  // namespace

Result<DaemonOptions> parse_arguments(int argc, const char* const* argv, int& exit_code) {
  DaemonOptions options;
  GivenOptions given;
  CLI::App app(
      "LiLoc client: localizes a device from its depth frames or clouds and, where there is one, its IMU or "
      "the "
      "odometry that others keep.",
      "liloc-client");
  declare(app, options, given);
  command::ProgramOptions program(app);
  if (const Status parsed = program.parse(argc, argv, exit_code); !parsed)
    return tl::unexpected(parsed.error());
  if (const Status ok = apply(given, options); !ok) {
    exit_code = 2;
    return tl::unexpected(program.located(ok.error()));
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
  return check_imu(options);
}

}  // namespace liloc
