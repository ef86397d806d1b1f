#include "proto-tests/toolbox/device_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "proto-tests/replay/evaluation.hpp"

namespace liloc::toolbox {
namespace {

std::string cell(const std::optional<double>& value, int decimals) {
  return value ? fmt::format("{:.{}f}", *value, decimals) : "-";
}

double yaw_deg(const Pose& T_map_sensor) {
  const Eigen::Vector3d forward = T_map_sensor.linear().col(2);
  return degrees(std::atan2(forward.y(), forward.x()));
}

std::optional<double> mean(const std::vector<double>& values) {
  if (values.empty()) return std::nullopt;
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

}  // namespace

std::vector<std::string> table_lines(const std::vector<DeviceRow>& rows) {
  std::vector<std::string> lines{fmt::format("{:<9} {:<10} {:>20} {:>7} {:>8} {:>7} {:>11}  {}", "device",
                                             "state", "x y z (m)", "yaw deg", "error cm", "deg", "latency ms",
                                             "spots verified/refused/asked")};
  for (const DeviceRow& row : rows) {
    std::string place = "-";
    std::optional<double> yaw;
    if (row.T_map_sensor) {
      const Eigen::Vector3d t = row.T_map_sensor->translation();
      place = fmt::format("{:.2f} {:.2f} {:.2f}", t.x(), t.y(), t.z());
      yaw = yaw_deg(*row.T_map_sensor);
    }
    lines.push_back(fmt::format("{:<9} {:<10} {:>20} {:>7} {:>8} {:>7} {:>11}  {}/{}/{} {}", row.id, row.state,
                                place, cell(yaw, 0), cell(row.error_cm, 1), cell(row.error_deg, 2),
                                cell(replay::percentile(row.news.latencies_ms, 0.5), 1), row.news.verified,
                                row.news.refused, row.news.asked, row.news.last_reason));
  }
  return lines;
}

std::vector<std::string> summary_lines(const std::vector<DeviceRow>& rows) {
  std::vector<std::string> lines;
  for (const DeviceRow& row : rows) {
    if (!row.first_pose_s) {
      lines.push_back(fmt::format("{}: never located; {} spots asked, the last one {} ({})", row.id,
                                  row.news.asked, row.news.last_status, row.news.last_reason));
      continue;
    }
    lines.push_back(fmt::format(
        "{}: located after {} s; mean error {} cm {} deg, at most {} cm {} deg; {} of {} spots verified, "
        "median {} ms",
        row.id, cell(row.first_pose_s, 1), cell(mean(row.errors_cm), 1), cell(mean(row.errors_deg), 2),
        cell(replay::percentile(row.errors_cm, 1), 1), cell(replay::percentile(row.errors_deg, 1), 2),
        row.news.verified, row.news.asked, cell(replay::percentile(row.news.latencies_ms, 0.5), 1)));
  }
  return lines;
}

void Screen::show(const std::vector<std::string>& lines) {
  if (terminal_ && shown_ > 0) fmt::print("\x1b[{}A", shown_);
  for (const std::string& line : lines) fmt::print("{}{}\n", line, terminal_ ? "\x1b[K" : "");
  std::fflush(stdout);
  shown_ = lines.size();
}

}  // namespace liloc::toolbox
