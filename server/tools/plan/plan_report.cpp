#include "server/tools/plan/plan_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/recording/json_fields.hpp"

namespace liloc::toolbox {
namespace {

using nlohmann::ordered_json;
using plan::DeviceModel;

/// Azimuth and tilt of a LiDAR, degrees.
std::pair<double, double> looks(const Pose& T_map_sensor) {
  const Eigen::Vector3d forward = T_map_sensor.linear().col(2);
  return {degrees(std::atan2(forward.y(), forward.x())),
          degrees(std::asin(std::clamp(-forward.z(), -1.0, 1.0)))};
}

/// How many views have a twin.
std::size_t twin_count(const plan::DeviceViews& devices) {
  return static_cast<std::size_t>(
      std::ranges::count_if(devices.twins, [](const plan::Twin& t) { return t.alike >= plan::kTwinAlike; }));
}

std::string study_tables(const plan::Study& study) {
  std::string text = "\nheight above floor   coverage   localizable   voxels seen\n";
  for (const plan::HeightRow& row : study.heights)
    text += fmt::format("{:16.2f} m {:8.1f} % {:11.1f} % {:13}\n", row.above_floor_m, 100 * row.coverage,
                        100 * row.localizable, row.voxels);
  text += "\ntilt below horizon   overlap    localizable\n";
  for (const plan::TiltRow& row : study.tilts)
    text += fmt::format("{:14.0f} deg {:8.1f} % {:11.1f} %\n", row.down_deg, 100 * row.overlap,
                        100 * row.localizable);
  text += "\nLiDARs   coverage: least   mean   most\n";
  for (const plan::CountRow& row : study.counts)
    text += fmt::format("{:6} {:15.1f} % {:5.1f} % {:5.1f} %\n", row.lidars, 100 * row.least, 100 * row.mean,
                        100 * row.most);
  return text;
}

ordered_json study_json(const plan::Study& study) {
  ordered_json heights = ordered_json::array(), tilts = heights, counts = heights;
  for (const plan::HeightRow& row : study.heights)
    heights.push_back({{"above_floor_m", row.above_floor_m},
                       {"coverage", row.coverage},
                       {"localizable", row.localizable},
                       {"voxels", row.voxels}});
  for (const plan::TiltRow& row : study.tilts)
    tilts.push_back({{"down_deg", row.down_deg}, {"overlap", row.overlap}, {"localizable", row.localizable}});
  for (const plan::CountRow& row : study.counts)
    counts.push_back({{"lidars", row.lidars}, {"least", row.least}, {"mean", row.mean}, {"most", row.most}});
  return {{"heights", heights}, {"tilts", tilts}, {"counts", counts}};
}

ordered_json lidars_json(const PlanInput& input, const PlanFindings& findings) {
  ordered_json list = ordered_json::array();
  for (std::size_t i = 0; i < findings.site.global_lidars.size(); ++i) {
    const GlobalLidar& lidar = findings.site.global_lidars[i];
    const plan::LidarWorth& worth = findings.evaluation.lidars[i];
    const auto [azimuth_deg, down_deg] = looks(lidar.T_map_sensor);
    ordered_json entry{{"id", lidar.id}};
    put_camera(entry, lidar.camera);
    entry["rate_hz"] = lidar.rate_hz;
    entry["T_map_sensor"] = pose_to_json(lidar.T_map_sensor);
    entry["above_floor_m"] = lidar.T_map_sensor.translation().z() - input.floor.floor_z_m;
    entry["azimuth_deg"] = azimuth_deg;
    entry["down_deg"] = down_deg;
    entry["coverage"] = worth.coverage;
    entry["hit_rate"] = worth.hit_rate;
    entry["localizable_lost_without"] = worth.lost;
    list.push_back(std::move(entry));
  }
  return list;
}

/// Each standing place with what becomes of its directions.
ordered_json places_json(const PlanInput& input, const PlanFindings& findings) {
  std::vector<std::vector<double>> chance(input.floor.places_map.size(),
                                          std::vector<double>(DeviceModel::kDirections, 0));
  const auto heights = static_cast<double>(input.device.heights_m.size());
  for (std::size_t i = 0; i < findings.devices.views.size(); ++i) {
    const plan::DeviceView& view = findings.devices.views[i];
    chance[view.place][static_cast<std::size_t>(view.direction)] += findings.evaluation.chances[i] / heights;
  }
  ordered_json list = ordered_json::array();
  for (std::size_t p = 0; p < chance.size(); ++p)
    list.push_back({{"x", input.floor.places_map[p].x()},
                    {"y", input.floor.places_map[p].y()},
                    {"localizable", findings.evaluation.place_chance[p]},
                    {"directions", chance[p]},
                    {"blind", static_cast<bool>(findings.evaluation.blind[p])}});
  return list;
}

ordered_json twins_json(const PlanInput& input, const PlanFindings& findings) {
  ordered_json list = ordered_json::array();
  const auto end_of = [&](const plan::DeviceView& view) {
    const Eigen::Vector2f& at = input.floor.places_map[view.place];
    return ordered_json{
        {"x", at.x()}, {"y", at.y()}, {"azimuth_deg", 360.0 * view.direction / DeviceModel::kDirections}};
  };
  for (std::size_t i = 0; i < findings.devices.twins.size(); ++i) {
    const plan::Twin& twin = findings.devices.twins[i];
    if (twin.alike < plan::kTwinAlike) continue;
    list.push_back({{"view", end_of(findings.devices.views[i])},
                    {"looks_like", end_of(findings.devices.views[twin.view])},
                    {"alike", twin.alike}});
  }
  return list;
}

}  // namespace

std::string plan_table(const PlanInput& input, const PlanFindings& findings) {
  const plan::Evaluation& e = findings.evaluation;
  std::string text =
      "LiDAR              x      y  above floor  azimuth    tilt   covers  hit rate  lost without\n";
  for (std::size_t i = 0; i < findings.site.global_lidars.size(); ++i) {
    const GlobalLidar& lidar = findings.site.global_lidars[i];
    const auto [azimuth_deg, down_deg] = looks(lidar.T_map_sensor);
    const Eigen::Vector3d at = lidar.T_map_sensor.translation();
    text += fmt::format(
        "{:<12} {:7.2f} {:6.2f} {:10.2f} m {:4.0f} deg {:3.0f} deg {:6.1f} % {:6.1f} % {:10.1f} %\n", lidar.id,
        at.x(), at.y(), at.z() - input.floor.floor_z_m, azimuth_deg, down_deg, 100 * e.lidars[i].coverage,
        100 * e.lidars[i].hit_rate, 100 * e.lidars[i].lost);
  }
  text += fmt::format(
      "localizable {:.1f} % of {} device poses ({} places, {} heights, {} directions); overlap {:.1f} %\n"
      "coverage {:.1f} % of the scan; free floor {:.1f} m2, of which {:.1f} m2 are blind; {:.1f} % of the "
      "views have "
      "a twin\n",
      100 * e.localizable, findings.devices.views.size(), input.floor.places_map.size(),
      input.device.heights_m.size(), DeviceModel::kDirections, 100 * e.overlap, 100 * e.coverage,
      input.floor.area_m2, e.blind_m2,
      100 * static_cast<double>(twin_count(findings.devices)) /
          static_cast<double>(std::max<std::size_t>(1, findings.devices.views.size())));
  return findings.study ? text + study_tables(*findings.study) : text;
}

ordered_json plan_json(const PlanInput& input, const PlanFindings& findings) {
  const plan::Evaluation& e = findings.evaluation;
  ordered_json object{{"lidars", lidars_json(input, findings)},
                      {"coverage", e.coverage},
                      {"localizable", e.localizable},
                      {"overlap", e.overlap},
                      {"floor_z_m", input.floor.floor_z_m},
                      {"ceiling_z_m", input.ceiling_z_m},
                      {"free_floor_m2", input.floor.area_m2},
                      {"blind_m2", e.blind_m2},
                      {"device_heights_m", input.device.heights_m},
                      {"places", places_json(input, findings)},
                      {"twins", twins_json(input, findings)}};
  if (findings.study) object["study"] = study_json(*findings.study);
  return object;
}

}  // namespace liloc::toolbox
