#include "server/tools/calibration_report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/recording/files.hpp"
#include "common/recording/json_fields.hpp"

namespace liloc::toolbox {
namespace {

constexpr std::size_t kLargestSite = 16U << 20U;  // bytes; read_site has accepted the file before

nlohmann::ordered_json json_of(const survey::LidarScan& scan, const survey::CalibratedLidar& result) {
  return {{"id", scan.lidar.id},
          {"T_map_sensor", pose_to_json(result.T_map_sensor)},
          {"moved_m", result.moved_m},
          {"moved_deg", degrees(result.moved_rad)},
          {"residual_m", result.evidence.residual_m},
          {"overlap", result.evidence.overlap},
          {"conflict", result.evidence.conflict},
          {"sd_m", result.evidence.sd_m},
          {"sd_deg", degrees(result.evidence.sd_rad)},
          {"depth_scale_error", result.error.scale},
          {"depth_scale_sd", result.error_sd.scale},
          {"depth_bias_m", result.error.bias_m},
          {"depth_bias_sd_m", result.error_sd.bias_m},
          {"trusted", result.trusted()},
          {"doubt", result.doubt}};
}

void print_row(const survey::LidarScan& scan, const survey::CalibratedLidar& result) {
  const survey::PoseEvidence& evidence = result.evidence;
  fmt::print(
      "{:<12} {:7.1f} {:6.2f}  {:6.1f} {:6.0f}% {:7.0f}%  {:5.1f} {:5.2f}  {:6.2f} +- {:4.2f} {:5.1f} +- "
      "{:3.1f}  {}\n",
      scan.lidar.id, 100 * result.moved_m, degrees(result.moved_rad), 1000 * evidence.residual_m,
      100 * evidence.overlap, 100 * evidence.conflict, 1000 * evidence.sd_m, degrees(evidence.sd_rad),
      100 * result.error.scale, 100 * result.error_sd.scale, 1000 * result.error.bias_m,
      1000 * result.error_sd.bias_m, result.trusted() ? "yes" : "no: " + result.doubt);
}

}  // namespace

void print_calibration(const std::vector<survey::LidarScan>& scans,
                       const std::vector<survey::CalibratedLidar>& results, bool json) {
  if (json) {
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (std::size_t i = 0; i < scans.size(); ++i) list.push_back(json_of(scans[i], results[i]));
    fmt::print("{}\n", nlohmann::ordered_json{{"lidars", list}}.dump());
    return;
  }
  fmt::print("{:<12} {:>7} {:>6}  {:>6} {:>7} {:>8}  {:>5} {:>5}  {:>14} {:>12}  {}\n", "LiDAR", "moved", "",
             "resid.", "overlap", "conflict", "sd", "", "depth scale", "bias", "trusted");
  fmt::print("{:<12} {:>7} {:>6}  {:>6} {:>7} {:>8}  {:>5} {:>5}  {:>14} {:>12}\n", "", "cm", "deg", "mm", "",
             "", "mm", "deg", "%", "mm");
  for (std::size_t i = 0; i < scans.size(); ++i) print_row(scans[i], results[i]);
}

Status write_calibrated(const std::filesystem::path& site, const std::filesystem::path& out,
                        const std::vector<survey::CalibratedLidar>& results) {
  const auto text = read_file(site, kLargestSite);
  if (!text) return tl::unexpected(text.error());
  auto object = nlohmann::ordered_json::parse(*text, nullptr, false);
  if (!object.is_object() || !object.contains("global_lidars") ||
      object["global_lidars"].size() != results.size())
    return fail("{}: changed while it was calibrated; start again", site.string());
  for (std::size_t i = 0; i < results.size(); ++i)
    object["global_lidars"][i]["T_map_sensor"] = pose_to_json(results[i].T_map_sensor);
  return write_file(out, object.dump(1) + "\n");
}

}  // namespace liloc::toolbox
