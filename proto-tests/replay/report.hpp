#pragma once
#include <cstdio>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "proto-tests/replay/evaluation.hpp"

namespace liloc::replay {

/// What a replay did besides its answers.
struct RunFacts {
  std::string recording, mode;  ///< mode: "lockstep" or "dds"
  std::uint64_t seed = 1;
  double wall_s = 0, recorded_s = 0;
  std::size_t ceiling_frames = 0, device_frames = 0;
  std::size_t ceiling_frames_used = 0, device_frames_used = 0;  ///< those that were sound
  std::map<std::string, double> client_cpu_s;    ///< of each device's engine; over DDS of its whole process
  std::map<std::string, double> client_peak_mb;  ///< of each client process, at most; DDS alone can tell
  std::vector<std::string> skipped;              ///< one line per frame that could not be used
};

struct Report {
  RunFacts run;
  std::vector<DeviceScore> devices;
};

/// As JSON; the figures carry the judge's names, absent ones are null.
[[nodiscard]] std::string to_json(const Report& report);
/// For people, at most 112 columns wide.
[[nodiscard]] std::string to_table(const Report& report);
/// Writes OUT/report.json whole or not at all.
[[nodiscard]] Status write_report(const std::filesystem::path& file, const Report& report);

}  // namespace liloc::replay
