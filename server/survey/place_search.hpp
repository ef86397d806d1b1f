#pragma once
// Places for LiDARs of which nothing is known.
#include <cstdint>
#include <optional>
#include <vector>

#include "server/survey/lidar_scan.hpp"
#include "server/survey/reference.hpp"

namespace liloc::survey {

struct FoundPlace {
  Pose T_map_sensor = Pose::Identity();
  bool twin = false;  ///< another place fits almost as well
};

/// By features of the scan; none: nothing is alike.
[[nodiscard]] std::optional<FoundPlace> find_in_scan(const LidarScan& scan, const Reference& reference,
                                                     std::uint64_t seed);

/// By features of other LiDARs: those in `search` are joined one by one to those that are placed, the surest
/// first. An element is none where `search` is false or nothing fits.
[[nodiscard]] std::vector<std::optional<FoundPlace>> find_by_overlap(const std::vector<LidarScan>& scans,
                                                                     const std::vector<bool>& search,
                                                                     std::uint64_t seed);

}  // namespace liloc::survey
