#include "client/app/options.hpp"

#include <CLI/CLI.hpp>
#include <cmath>
#include <map>
#include <tuple>

#include "common/recording/recording.hpp"
#include "common/wire/sensors.hpp"

namespace liloc {
namespace {

struct Raw {
  std::string local = "cloud", log_level = "info";
  std::vector<double> imu_translation, imu_rotation, base_translation, base_rotation;
  std::vector<double> points_view{96, 72, 90, 74};
  std::string depth, camera_info, points, imu, odometry, pose, odom, diagnostics;
  std::string map_frame, odom_frame, sensor_frame;
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
}

void declare_topics(CLI::App& app, Raw& raw) {
  auto* topics = app.add_option_group("input", "ROS names of the sensors' topics");
  topics->add_option("--depth-topic", raw.depth, "Image, 16UC1 or 32FC1; default: <id>/depth/image_rect_raw");
  topics->add_option("--camera-info-topic", raw.camera_info,
                     "CameraInfo, the intrinsics without --device; default: <id>/depth/camera_info");
  topics->add_option("--points-topic", raw.points, "PointCloud2 in the sensor's frame, in place of the image");
  topics
      ->add_option("--points-view", raw.points_view,
                   "Part of the cloud that is used, without --device: columns, rows, degrees across and down, "
                   "with about one pixel per point")
      ->expected(4)
      ->capture_default_str();
  topics->add_option("--imu-topic", raw.imu, "Imu; default: <id>/imu");
  topics->add_option("--odometry-topic", raw.odometry,
                     "Odometry that others keep: the client then does the global part alone");
  topics
      ->add_option("--base-translation", raw.base_translation,
                   "T_base_sensor: the depth sensor on what that odometry moves, x y z in m")
      ->expected(3);
  topics->add_option("--base-rotation", raw.base_rotation, "The same: quaternion x y z w")->expected(4);
}

void declare_ros(CLI::App& app, RosOptions& ros, Raw& raw) {
  auto* group = app.add_option_group("ros", "What is told to ROS");
  group->add_flag("--ros", ros.enabled,
                  "Find the drivers of this host; publish pose, odometry, tf and diagnostics");
  group->add_option("--pose-topic", raw.pose, "PoseWithCovarianceStamped; default: <id>/pose");
  group->add_option("--odom-topic", raw.odom, "Odometry; default: <id>/odom");
  group->add_option("--diagnostics-topic", raw.diagnostics, "DiagnosticArray; default: diagnostics");
  group->add_option("--map-frame", raw.map_frame, "Default: map");
  group->add_option("--odom-frame", raw.odom_frame,
                    "Default: <id>/odom; with --odometry-topic odom, the frame of those messages");
  group->add_option("--sensor-frame", raw.sensor_frame, "Default: <id>/depth_optical_frame");
  group
      ->add_option("--tf-ahead-ms", ros.tf_ahead_ms,
                   "Stamp map -> odom so far ahead, that it holds until the next frame")
      ->check(CLI::Range(0.0, 2000.0))
      ->capture_default_str();
  group
      ->add_option("--tf-max-speed", ros.tf_max_speed_m_s,
                   "Corrections move map -> odom by this in m/s; 0: at once")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  group->add_option("--tf-max-turn", ros.tf_max_turn_deg_s, "The same in degrees per second")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
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
  declare_topics(app, raw);
  declare_ros(app, options.ros, raw);

  auto* method = app.add_option_group("localization");
  method->add_option("--interval-ms", c.interval_ms, "Upper bound between global registrations")
      ->check(CLI::Range(50, 60'000))
      ->capture_default_str();
  method
      ->add_option(
          "--searching-interval-ms", c.searching_interval_ms,
          "Lower bound while nothing is verified: an answer brings the next request forward; 0: a quarter "
          "of --interval-ms")
      ->check(CLI::Range(0, 60'000))
      ->capture_default_str();
  method->add_option("--reply-timeout-ms", c.reply_timeout_ms, "A request older than so counts as unanswered")
      ->check(CLI::Range(100, 600'000))
      ->capture_default_str();
  method->add_option("--voxel", c.voxel_size_m, "Voxel size of the cloud that is sent, m")
      ->capture_default_str();
  method->add_option("--local", raw.local, "Local registration: cloud, inertial or dead-reckoning")
      ->capture_default_str();
  method
      ->add_option("--cpu-share", c.cpu_share,
                   "Of one core for the registration; frames are left out to keep it")
      ->check(CLI::Range(0.02, 1.0))
      ->capture_default_str();
  method->add_flag("!--no-submap", c.submap, "Send the frame alone, without what stands around");
  method
      ->add_option("--request-bytes", c.request_bytes,
                   "Most, of a request's clouds: the surroundings give way first, then the frame is thinned")
      ->check(CLI::Range(2000, 60'000))
      ->capture_default_str();
  method->add_flag("--cold", c.cold, "Each request is answered on its own");
  method->add_option("--seed", c.seed, "Of all randomness")->capture_default_str();

  app.add_option("--trace", c.trace_folder, "Write online.tum, trajectory.tum, spots.csv and local.csv here");
  app.add_option("--log-level", raw.log_level, "debug, info, warning or error")->capture_default_str();
}

/// Both numbers of a mounting or neither.
Status settle_pose(const std::string& name, const std::vector<double>& translation,
                   const std::vector<double>& rotation, std::optional<client::Pose>& to) {
  if (translation.empty() != rotation.empty())
    return fail("--{0}-translation and --{0}-rotation go together: give both or neither", name);
  if (translation.empty()) return {};
  to.emplace();
  std::copy_n(translation.begin(), 3, to->translation_m.begin());
  std::copy_n(rotation.begin(), 4, to->rotation_xyzw.begin());
  return {};
}

Status settle_name(const std::string& given, const std::string& usual, std::string& to) {
  const auto topic = wire::dds_topic(given.empty() ? usual : given);
  if (!topic) return tl::unexpected(topic.error());
  to = *topic;
  return {};
}

Status settle_topics(DaemonOptions& options, const Raw& raw) {
  const std::string& id = options.client.id;
  SensorTopics& in = options.topics;
  wire::RosNames& out = options.ros.names;
  out = wire::RosNames::of(id);
  in.use_points = !raw.points.empty();
  const bool external = !raw.odometry.empty();
  const std::tuple<std::string, std::string, std::string*> names[] = {
      {raw.depth, id + "/depth/image_rect_raw", &in.depth},
      {raw.camera_info, id + "/depth/camera_info", &in.camera_info},
      {raw.points, id + "/points", &in.points},
      {raw.imu, id + "/imu", &in.imu},
      {raw.pose, id + "/pose", &out.pose},
      {raw.odom, id + "/odom", &out.odometry},
      {raw.diagnostics, "diagnostics", &out.diagnostics}};
  for (const auto& [given, usual, to] : names)
    if (const Status ok = settle_name(given, usual, *to); !ok) return ok;
  if (external) {
    if (const Status ok = settle_name(raw.odometry, "", in.odometry); !ok) return ok;
    options.client.local = client::Local::external;
    out.odom_frame = "odom";
  } else if (!raw.base_translation.empty()) {
    return fail("--base-... says how the sensor is mounted for --odometry-topic: give that, or leave it out");
  }
  if (!raw.map_frame.empty()) out.world_frame = raw.map_frame;
  if (!raw.odom_frame.empty()) out.odom_frame = raw.odom_frame;
  if (!raw.sensor_frame.empty()) out.sensor_frame = raw.sensor_frame;
  return settle_pose("base", raw.base_translation, raw.base_rotation, options.client.T_base_sensor);
}

/// The camera whose image stands for a cloud.
Status settle_points_view(DaemonOptions& options, const std::vector<double>& view) {
  if (!options.topics.use_points || !options.device_file.empty()) return {};
  const double width = view[0], height = view[1], across = radians(view[2]), down = radians(view[3]);
  if (!(width >= 16 && width <= 2048 && height >= 16 && height <= 2048 && across > 0.1 && across < 2.8 &&
        down > 0.1 && down < 2.8))
    return fail("--points-view is {} {} {} {}; must be 16..2048 columns and rows, and 6..160 degrees", view[0],
                view[1], view[2], view[3]);
  client::Camera& c = options.client.camera;
  c = {static_cast<int>(width), static_cast<int>(height), 0, 0, 0, 0, 0.001};
  c.fx = c.width / (2 * std::tan(across / 2));
  c.fy = c.height / (2 * std::tan(down / 2));
  c.cx = (c.width - 1) / 2.0;
  c.cy = (c.height - 1) / 2.0;
  return {};
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
  if (const Status ok = settle_pose("imu", raw.imu_translation, raw.imu_rotation, options.client.T_imu_sensor);
      !ok)
    return ok;
  if (options.client.T_imu_sensor && !options.device_file.empty())
    return fail("--imu-... and --device contradict each other: give one of them");
  if (const Status ok = settle_topics(options, raw); !ok) return ok;
  return settle_points_view(options, raw.points_view);
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
      "LiLoc client: localizes a device from its depth frames or clouds and, where there is one, its IMU or "
      "the "
      "odometry that others keep.",
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
