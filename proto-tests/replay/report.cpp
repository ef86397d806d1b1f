#include "proto-tests/replay/report.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "common/recording/files.hpp"

namespace liloc::replay {
namespace {

using Json = nlohmann::ordered_json;

Json json_of(const std::optional<double>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json json_of(const TrackScore& track) {
  return {{"coverage", track.coverage},
          {"mean_rot_deg", json_of(track.mean_rot_deg)},
          {"mean_trans_m", json_of(track.mean_trans_m)},
          {"median_rot_deg", json_of(track.median_rot_deg)},
          {"median_trans_m", json_of(track.median_trans_m)},
          {"frames_over_10deg_0.3m", json_of(track.frames_over_10deg_03m)},
          {"correct", track.correct}};
}

Json json_of(const DoubtScore& doubt) {
  return {{"poses", doubt.poses},
          {"nees_mean", json_of(doubt.nees_mean)},
          {"nees_median", json_of(doubt.nees_median)},
          {"beyond_22.5", json_of(doubt.beyond)},
          {"wrong_untold", json_of(doubt.wrong_untold)}};
}

Json json_of(const SpotScore& spots) {
  return {{"n", spots.n},
          {"n_overlap", spots.n_overlap},
          {"loose", json_of(spots.loose)},
          {"strict", json_of(spots.strict)},
          {"verified", spots.verified},
          {"verified_wrong", spots.verified_wrong},
          {"latency_ms_median", json_of(spots.latency_ms_median)},
          {"latency_ms_p99", json_of(spots.latency_ms_p99)}};
}

Json json_of(const LocalScore& local) {
  return {{"end_pct_of_path", local.end_pct_of_path},
          {"end_rot_deg", local.end_rot_deg},
          {"path_m", local.path_m},
          {"pairs", local.pairs},
          {"ok_3deg_0.1m", json_of(local.ok_3deg_01m)},
          {"median_trans_m", json_of(local.median_trans_m)},
          {"median_rot_deg", json_of(local.median_rot_deg)},
          {"latency_ms_median", json_of(local.latency_ms_median)}};
}

/// CPU time of the device's engine for each second with a pose.
std::optional<double> cpu_ms_per_localized_s(const RunFacts& run, const DeviceScore& device) {
  const auto cpu = run.client_cpu_s.find(device.id);
  const double localized_s = device.online.coverage * run.recorded_s;
  if (cpu == run.client_cpu_s.end() || localized_s <= 0) return std::nullopt;
  return 1e3 * cpu->second / localized_s;
}

Json json_of(const DeviceScore& device) {
  Json json{{"frames", device.frames},
            {"has_truth", device.has_truth},
            {"first_pose_ms", json_of(device.first_pose_ms)},
            {"online", json_of(device.online)},
            {"doubt", json_of(device.doubt)},
            {"trajectory", json_of(device.trajectory)},
            {"spots", json_of(device.spots)},
            {"reasons", device.reasons}};
  if (device.local) json["local"] = json_of(*device.local);
  return json;
}

std::string cell(const std::optional<double>& value, int decimals, double factor = 1) {
  return value ? fmt::format("{:.{}f}", *value * factor, decimals) : "-";
}

void add_row(std::string& table, std::string_view name, std::string_view text) {
  table += fmt::format("  {:<22} {}\n", name, text);
}

std::string track_text(const TrackScore& track, bool has_truth) {
  if (!has_truth) return fmt::format("{:.1f} % of frames have a pose", 100 * track.coverage);
  return fmt::format(
      "{:.1f} % of frames; mean {} cm {} deg, median {} cm {} deg; {} % off by more than 10 deg or 0.3 m",
      100 * track.coverage, cell(track.mean_trans_m, 1, 100), cell(track.mean_rot_deg, 2),
      cell(track.median_trans_m, 1, 100), cell(track.median_rot_deg, 2),
      cell(track.frames_over_10deg_03m, 1, 100));
}

void add_device(std::string& table, const RunFacts& run, const DeviceScore& device) {
  table +=
      fmt::format("{}: {} frames{}\n", device.id, device.frames, device.has_truth ? "" : ", no ground truth");
  add_row(table, "online poses", track_text(device.online, device.has_truth));
  if (device.doubt.poses > 0)
    add_row(table, "their covariances",
            fmt::format("NEES {} (median {}; 6 and 5.3 are right), {} % beyond 22.5; {} % wrong and not told",
                        cell(device.doubt.nees_mean, 1), cell(device.doubt.nees_median, 1),
                        cell(device.doubt.beyond, 1, 100), cell(device.doubt.wrong_untold, 1, 100)));
  add_row(table, "corrected trajectory", track_text(device.trajectory, device.has_truth));
  const SpotScore& spots = device.spots;
  std::string text = fmt::format("{} asked, {} verified", spots.n, spots.verified);
  if (device.has_truth)
    text += fmt::format(" ({} wrong); of {} with overlap {} % within 10 deg 0.3 m, {} % within 3 deg 0.1 m",
                        spots.verified_wrong, spots.n_overlap, cell(spots.loose, 1, 100),
                        cell(spots.strict, 1, 100));
  add_row(table, "spots", text);
  std::string reasons;
  for (const auto& [reason, count] : device.reasons)
    reasons += fmt::format("{}{} {}", reasons.empty() ? "" : ", ", count, reason);
  add_row(table, "reasons", reasons.empty() ? "-" : reasons);
  add_row(table, "spot latency",
          fmt::format("median {} ms, p99 {} ms; first pose after {} ms", cell(spots.latency_ms_median, 1),
                      cell(spots.latency_ms_p99, 1), cell(device.first_pose_ms, 0)));
  if (const auto cpu_ms = cpu_ms_per_localized_s(run, device))
    add_row(table, "client CPU", fmt::format("{:.1f} ms per localized second", *cpu_ms));
  if (const auto peak = run.client_peak_mb.find(device.id); peak != run.client_peak_mb.end())
    add_row(table, "client memory", fmt::format("{:.0f} MB at most", peak->second));
  if (!device.local) return;
  const LocalScore& local = *device.local;
  text = fmt::format("median {} ms a frame", cell(local.latency_ms_median, 2));
  if (device.has_truth)
    text += fmt::format("; drift {:.2f} % of {:.1f} m, {:.2f} deg; {} % of {} steps within 3 deg 0.1 m",
                        local.end_pct_of_path, local.path_m, local.end_rot_deg, cell(local.ok_3deg_01m, 1, 100),
                        local.pairs);
  add_row(table, "local registration", text);
}

}  // namespace

std::string to_json(const Report& report) {
  const RunFacts& run = report.run;
  Json json{{"recording", run.recording},
            {"mode", run.mode},
            {"seed", run.seed},
            {"wall_s", run.wall_s},
            {"recorded_s", run.recorded_s},
            {"ceiling_frames", run.ceiling_frames},
            {"device_frames", run.device_frames},
            {"skipped", run.skipped},
            {"devices", Json::object()}};
  for (const DeviceScore& device : report.devices) {
    Json& entry = json["devices"][device.id] = json_of(device);
    entry["client_cpu_ms_per_localized_s"] = json_of(cpu_ms_per_localized_s(run, device));
    if (const auto peak = run.client_peak_mb.find(device.id); peak != run.client_peak_mb.end())
      entry["client_memory_mb"] = peak->second;
  }
  return json.dump(1) + "\n";
}

std::string to_table(const Report& report) {
  const RunFacts& run = report.run;
  std::string table = fmt::format(
      "{} ({}, seed {}): {:.1f} s recorded, {:.1f} s taken; {} ceiling frames, {} device frames\n",
      run.recording, run.mode, run.seed, run.recorded_s, run.wall_s, run.ceiling_frames, run.device_frames);
  for (const DeviceScore& device : report.devices) add_device(table, run, device);
  if (report.devices.empty()) table += "no device in this recording: nothing to locate\n";
  if (!run.skipped.empty()) {
    table += fmt::format("{} frames skipped, the first: {}\n", run.skipped.size(), run.skipped.front());
  }
  return table;
}

Status write_report(const std::filesystem::path& file, const Report& report) {
  return write_file(file, to_json(report));
}

}  // namespace liloc::replay
