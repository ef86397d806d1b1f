#pragma once
#include <filesystem>

#include "server/survey/calibration.hpp"

namespace liloc::toolbox {

/// A table, or with `json` one object, on stdout.
void print_calibration(const std::vector<survey::LidarScan>& scans,
                       const std::vector<survey::CalibratedLidar>& results, bool json);

/// Writes `out`: the site file with the places found, everything else in it as it was. Complete or not at all.
/// `results` in the order of the site's LiDARs.
[[nodiscard]] Status write_calibrated(const std::filesystem::path& site, const std::filesystem::path& out,
                                      const std::vector<survey::CalibratedLidar>& results);

}  // namespace liloc::toolbox
