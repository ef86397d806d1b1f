#pragma once
// The demo's table: per device where it is told to be, how far that is from the truth, and how its spots fared.
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/pose.hpp"
#include "proto-tests/toolbox/trace_tail.hpp"

namespace liloc::toolbox {

/// A device's figures since the start.
struct DeviceRow {
  std::string id;
  std::string state = "searching";  ///< searching, tracking, or lost (no pose for a second)
  std::optional<Pose> T_map_sensor;
  std::optional<double> error_cm, error_deg;  ///< of the newest pose
  std::optional<double> first_pose_s;         ///< since the first frame
  std::vector<double> errors_cm, errors_deg;  ///< of all poses that have a truth
  DeviceNews news;
};

/// Header and one line per device, without a trailing line break. Positions in metres, map frame.
[[nodiscard]] std::vector<std::string> table_lines(const std::vector<DeviceRow>& rows);
/// One line per device for the end: mean and largest error, median latency, spots.
[[nodiscard]] std::vector<std::string> summary_lines(const std::vector<DeviceRow>& rows);

/// Prints blocks of lines: on a terminal each over the last one, otherwise one below the other.
class Screen {
 public:
  explicit Screen(bool terminal) : terminal_(terminal) {}
  void show(const std::vector<std::string>& lines);

 private:
  const bool terminal_;
  std::size_t shown_ = 0;
};

}  // namespace liloc::toolbox
