#include "client/app/given_options.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "common/command/text.hpp"
#include "common/geometry/pose.hpp"
#include "common/wire/dds/participant.hpp"
#include "common/wire/sensors/sensors.hpp"

namespace liloc {
namespace {

/// Both numbers of a mounting or neither.
Status apply_pose(const std::string& name, const std::vector<double>& translation,
                  const std::vector<double>& rotation, std::optional<client::Pose>& to) {
  if (translation.empty() != rotation.empty())
    return fail("--{0}-translation and --{0}-rotation go together: give both or neither", name);
  if (translation.empty()) return {};
  to.emplace();
  std::copy_n(translation.begin(), 3, to->translation_m.begin());
  std::copy_n(rotation.begin(), 4, to->rotation_xyzw.begin());
  const auto T = valid_pose(Eigen::Vector3d(translation.data()), Eigen::Vector4d(rotation.data()), name);
  if (T) return {};
  // It names a file's fields, "imu.rotation_xyzw has length 2": on the command line they have flags.
  std::string message = "--" + T.error().message;
  for (const auto& [field, flag] :
       {std::pair{".rotation_xyzw", "-rotation"}, std::pair{".translation", "-translation"}})
    if (const auto at = message.find(field); at != std::string::npos)
      message.replace(at, std::string(field).size(), flag);
  return tl::unexpected(Error{message});
}

Status apply_name(const char* flag, const std::string& given, const std::string& usual, std::string& to) {
  const auto topic = wire::dds_topic(given.empty() ? usual : given);
  if (!topic)
    return fail("{} is '{}'; give a ROS name: letters, digits, _ and /, at most 200", flag,
                command::excerpt(given));
  to = *topic;
  return {};
}

/// As tf2 has it: no leading slash, no blank, and a frame is not its own parent.
Status check_frames(const wire::RosNames& names) {
  constexpr std::size_t kLongest = 200;  // as of a topic
  const std::pair<const char*, const std::string*> frames[] = {{"--map-frame", &names.world_frame},
                                                               {"--odom-frame", &names.odom_frame},
                                                               {"--sensor-frame", &names.sensor_frame}};
  for (const auto& [flag, name] : frames) {
    const bool plain = std::ranges::all_of(*name, [](unsigned char c) { return c > ' ' && c != 0x7f; });
    if (name->empty() || name->size() > kLongest || name->front() == '/' || !plain)
      return fail("{} is '{}'; tf2 takes no leading /, no blank and no empty name", flag,
                  command::excerpt(*name));
    for (const auto& [other_flag, other] : frames)
      if (other != name && *other == *name)
        return fail("{} and {} are both '{}'; give them different names", other_flag, flag,
                    command::excerpt(*name));
  }
  return {};
}

/// Hosts and the interface; they go into the transport's configuration.
Status check_network(const client::Options& c) {
  wire::DomainOptions seat;
  seat.domain = c.domain;
  seat.interface = c.network_interface;
  seat.peers = c.peers;
  if (const Status ok = wire::check(seat); !ok) return fail("--{}", command::one_line(ok.error().message));
  return {};
}

Status apply_topics(const GivenOptions& given, DaemonOptions& options) {
  const std::string& id = options.client.id;
  SensorTopics& in = options.topics;
  wire::RosNames& out = options.ros.names;
  out = wire::RosNames::of(id);
  in.use_points = !given.points.empty();
  const std::tuple<const char*, std::string, std::string, std::string*> names[] = {
      {"--depth-topic", given.depth, id + "/depth/image_rect_raw", &in.depth},
      {"--camera-info-topic", given.camera_info, id + "/depth/camera_info", &in.camera_info},
      {"--points-topic", given.points, id + "/points", &in.points},
      {"--imu-topic", given.imu, id + "/imu", &in.imu},
      {"--pose-topic", given.pose, id + "/pose", &out.pose},
      {"--odom-topic", given.odom, id + "/odom", &out.odometry},
      {"--diagnostics-topic", given.diagnostics, "diagnostics", &out.diagnostics}};
  for (const auto& [flag, typed, usual, to] : names)
    if (const Status ok = apply_name(flag, typed, usual, *to); !ok) return ok;
  if (!given.odometry.empty()) out.odom_frame = "odom";
  if (!given.map_frame.empty()) out.world_frame = given.map_frame;
  if (!given.odom_frame.empty()) out.odom_frame = given.odom_frame;
  if (!given.sensor_frame.empty()) out.sensor_frame = given.sensor_frame;
  return check_frames(out);
}

/// Odometry that others keep, and where the sensor sits on what it moves.
Status apply_odometry(const GivenOptions& given, DaemonOptions& options) {
  if (given.odometry.empty() && !given.base_translation.empty())
    return fail("--base-... says how the sensor is mounted for --odometry-topic: give that, or leave it out");
  if (!given.odometry.empty()) {
    if (const Status ok = apply_name("--odometry-topic", given.odometry, "", options.topics.odometry); !ok)
      return ok;
    options.client.local = client::Local::external;
  }
  return apply_pose("base", given.base_translation, given.base_rotation, options.client.T_base_sensor);
}

/// The camera whose image stands for a cloud.
Status apply_points_view(const std::vector<double>& view, DaemonOptions& options) {
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

}  // namespace

Status check_imu(const DaemonOptions& options) {
  const auto local = options.client.local;
  if (options.client.T_imu_sensor || local == client::Local::cloud || local == client::Local::external)
    return {};
  return fail(
      "--local {} needs an IMU: give --imu-translation and --imu-rotation, a --device that has one, or "
      "--local cloud",
      local == client::Local::inertial ? "inertial" : "dead-reckoning");
}

Status apply(const GivenOptions& given, DaemonOptions& options) {
  static const std::map<std::string, client::Local> methods{{"cloud", client::Local::cloud},
                                                            {"inertial", client::Local::inertial},
                                                            {"dead-reckoning", client::Local::dead_reckoning}};
  const auto method = methods.find(given.local);
  if (method == methods.end())
    return fail("--local is '{}'; must be cloud, inertial or dead-reckoning", given.local);
  static const std::map<std::string, client::Codec> codecs{
      {"draco", client::Codec::draco}, {"voxel", client::Codec::voxel}, {"octree", client::Codec::octree}};
  const auto codec = codecs.find(given.codec);
  if (codec == codecs.end()) return fail("--codec is '{}'; must be draco, voxel or octree", given.codec);
  const auto level = log::level_from(given.log_level);
  if (!level) return fail("--log-level: {}", level.error().message);
  options.client.local = method->second;
  options.client.codec = codec->second;
  options.log_level = *level;
  if (const Status ok =
          apply_pose("imu", given.imu_translation, given.imu_rotation, options.client.T_imu_sensor);
      !ok)
    return ok;
  if (options.client.T_imu_sensor && !options.device_file.empty())
    return fail("--imu-... and --device contradict each other: give one of them");
  if (const Status ok = check_network(options.client); !ok) return ok;
  if (const Status ok = apply_topics(given, options); !ok) return ok;
  if (const Status ok = apply_odometry(given, options); !ok) return ok;
  if (options.device_file.empty())
    if (const Status ok = check_imu(options); !ok) return ok;
  return apply_points_view(given.points_view, options);
}

}  // namespace liloc
