#include "client/app/given_options.hpp"

#include <cmath>
#include <map>
#include <tuple>

#include "common/geometry/pose.hpp"
#include "common/wire/sensors.hpp"

namespace liloc {
namespace {

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

Status settle_topics(const GivenOptions& given, DaemonOptions& options) {
  const std::string& id = options.client.id;
  SensorTopics& in = options.topics;
  wire::RosNames& out = options.ros.names;
  out = wire::RosNames::of(id);
  in.use_points = !given.points.empty();
  const std::tuple<std::string, std::string, std::string*> names[] = {
      {given.depth, id + "/depth/image_rect_raw", &in.depth},
      {given.camera_info, id + "/depth/camera_info", &in.camera_info},
      {given.points, id + "/points", &in.points},
      {given.imu, id + "/imu", &in.imu},
      {given.pose, id + "/pose", &out.pose},
      {given.odom, id + "/odom", &out.odometry},
      {given.diagnostics, "diagnostics", &out.diagnostics}};
  for (const auto& [typed, usual, to] : names)
    if (const Status ok = settle_name(typed, usual, *to); !ok) return ok;
  if (!given.odometry.empty()) out.odom_frame = "odom";
  if (!given.map_frame.empty()) out.world_frame = given.map_frame;
  if (!given.odom_frame.empty()) out.odom_frame = given.odom_frame;
  if (!given.sensor_frame.empty()) out.sensor_frame = given.sensor_frame;
  return {};
}

/// Odometry that others keep, and where the sensor sits on what it moves.
Status settle_odometry(const GivenOptions& given, DaemonOptions& options) {
  if (given.odometry.empty() && !given.base_translation.empty())
    return fail("--base-... says how the sensor is mounted for --odometry-topic: give that, or leave it out");
  if (!given.odometry.empty()) {
    if (const Status ok = settle_name(given.odometry, "", options.topics.odometry); !ok) return ok;
    options.client.local = client::Local::external;
  }
  return settle_pose("base", given.base_translation, given.base_rotation, options.client.T_base_sensor);
}

/// The camera whose image stands for a cloud.
Status settle_points_view(const std::vector<double>& view, DaemonOptions& options) {
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

Status settle(const GivenOptions& given, DaemonOptions& options) {
  static const std::map<std::string, client::Local> methods{{"cloud", client::Local::cloud},
                                                            {"inertial", client::Local::inertial},
                                                            {"dead-reckoning", client::Local::dead_reckoning}};
  const auto method = methods.find(given.local);
  if (method == methods.end())
    return fail("--local is '{}'; must be cloud, inertial or dead-reckoning", given.local);
  const auto level = log::level_from(given.log_level);
  if (!level) return fail("--log-level: {}", level.error().message);
  options.client.local = method->second;
  options.log_level = *level;
  if (const Status ok =
          settle_pose("imu", given.imu_translation, given.imu_rotation, options.client.T_imu_sensor);
      !ok)
    return ok;
  if (options.client.T_imu_sensor && !options.device_file.empty())
    return fail("--imu-... and --device contradict each other: give one of them");
  if (const Status ok = settle_topics(given, options); !ok) return ok;
  if (const Status ok = settle_odometry(given, options); !ok) return ok;
  return settle_points_view(given.points_view, options);
}

}  // namespace liloc
