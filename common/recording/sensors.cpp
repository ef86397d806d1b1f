// site.json and device.json, both ways.
#include <set>

#include "common/base/ids.hpp"
#include "common/base/ros_name.hpp"
#include "common/recording/files.hpp"
#include "common/recording/json_fields.hpp"
#include "common/recording/site_extent.hpp"
#include "common/recording/writer.hpp"

namespace liloc {
namespace {

constexpr double kSlowestHz = 0.01, kFastestHz = 10'000, kLongestStillSeconds = 3600;  // by hand

Result<GlobalLidar> lidar_of(const JsonFields& fields) {
  GlobalLidar lidar;
  const auto id =
      fields.text("id").and_then([&](const std::string& s) { return valid_id(s, fields.path("id")); });
  if (!id) return tl::unexpected(id.error());
  const auto camera = fields.camera();
  if (!camera) return tl::unexpected(camera.error());
  const auto rate_hz = fields.number("rate_hz", kSlowestHz, kFastestHz);
  if (!rate_hz) return tl::unexpected(rate_hz.error());
  const auto T_map_sensor = fields.pose("T_map_sensor");
  if (!T_map_sensor) return tl::unexpected(T_map_sensor.error());
  return GlobalLidar{*id, *camera, *rate_hz, *T_map_sensor};
}

Status read_inertial(const JsonFields& fields, DeviceInfo& device) {
  if (fields.has("imu_rate_hz")) {
    const auto rate_hz = fields.number("imu_rate_hz", kSlowestHz, kFastestHz);
    if (!rate_hz) return tl::unexpected(rate_hz.error());
    device.imu_rate_hz = *rate_hz;
  }
  if (fields.has("T_imu_sensor")) {
    const auto T_imu_sensor = fields.pose("T_imu_sensor");
    if (!T_imu_sensor) return tl::unexpected(T_imu_sensor.error());
    device.T_imu_sensor = *T_imu_sensor;
  }
  return {};
}

}  // namespace

Result<Site> read_site(const std::filesystem::path& file) {
  const std::string name = file.string();
  const auto object = read_json_object(name);
  if (!object) return tl::unexpected(object.error());
  const JsonFields fields(*object, name + ": site");
  Site site;
  if (fields.has("world_frame")) {
    const auto frame = fields.text("world_frame").and_then([&](const std::string& s) {
      return valid_id(s, fields.path("world_frame"));
    });
    if (!frame) return tl::unexpected(frame.error());
    site.world_frame = *frame;
  }
  const auto list = object->find("global_lidars");
  if (list == object->end() || !list->is_array() || list->empty())
    return fail("{}: global_lidars is missing or empty; list at least one LiDAR", name);
  std::set<std::string> seen;
  for (std::size_t i = 0; i < list->size(); ++i) {
    const std::string where = fmt::format("{}: global_lidars[{}]", name, i);
    if (!(*list)[i].is_object())
      return fail("{} is a {}; give an object {{...}}", where, (*list)[i].type_name());
    auto lidar = lidar_of(JsonFields((*list)[i], where));
    if (!lidar) return tl::unexpected(lidar.error());
    if (!seen.insert(ros_name(lidar->id)).second)
      return fail("{}.id '{}' is used twice (- and _ are one in the names of topics); rename one", where,
                  lidar->id);
    site.global_lidars.push_back(std::move(*lidar));
  }
  if (const Status extent = check_extent(name, site.global_lidars); !extent)
    return tl::unexpected(extent.error());
  return site;
}

Result<DeviceInfo> read_device(const std::filesystem::path& file) {
  const std::string name = file.string();
  const auto object = read_json_object(name);
  if (!object) return tl::unexpected(object.error());
  const JsonFields fields(*object, name + ": device");
  DeviceInfo device;
  const auto id =
      fields.text("id").and_then([&](const std::string& s) { return valid_id(s, fields.path("id")); });
  if (!id) return tl::unexpected(id.error());
  device.id = *id;
  const auto camera = fields.camera();
  if (!camera) return tl::unexpected(camera.error());
  device.camera = *camera;
  const auto rate_hz = fields.number("rate_hz", kSlowestHz, kFastestHz);
  if (!rate_hz) return tl::unexpected(rate_hz.error());
  device.rate_hz = *rate_hz;
  if (fields.has("still_seconds")) {
    const auto still = fields.number("still_seconds", 0, kLongestStillSeconds);
    if (!still) return tl::unexpected(still.error());
    device.still_seconds = *still;
  }
  if (auto inertial = read_inertial(fields, device); !inertial) return tl::unexpected(inertial.error());
  return device;
}

Status write_site(const std::filesystem::path& file, const Site& site) {
  nlohmann::ordered_json object;
  object["world_frame"] = site.world_frame;
  auto& list = object["global_lidars"] = nlohmann::ordered_json::array();
  for (const auto& lidar : site.global_lidars) {
    nlohmann::ordered_json entry;
    entry["id"] = lidar.id;
    put_camera(entry, lidar.camera);
    entry["rate_hz"] = lidar.rate_hz;
    entry["T_map_sensor"] = pose_to_json(lidar.T_map_sensor);
    list.push_back(std::move(entry));
  }
  return write_file(file, object.dump(1) + "\n");
}

Status write_device(const std::filesystem::path& file, const DeviceInfo& device) {
  nlohmann::ordered_json object;
  object["id"] = device.id;
  put_camera(object, device.camera);
  object["rate_hz"] = device.rate_hz;
  object["still_seconds"] = device.still_seconds;
  if (device.imu_rate_hz) object["imu_rate_hz"] = *device.imu_rate_hz;
  if (device.T_imu_sensor) object["T_imu_sensor"] = pose_to_json(*device.T_imu_sensor);
  return write_file(file, object.dump(1) + "\n");
}

}  // namespace liloc
