#pragma once
// Where the trials of `liloc_spot_bench` take place: simulated sites by seed, and recordings.
#include <functional>
#include <memory>
#include <string>

#include "proto-tests/sim/simulation.hpp"

namespace liloc::bench {

/// A site with its sensors, and what they deliver. Recordings speak as the simulator does.
struct Stage {
  std::string name;  ///< for people; a simulated site's starts with its kind
  std::uint64_t seed = 0;
  Site site;
  std::vector<DeviceInfo> devices;
  std::function<std::optional<sim::SimEvent>()> next;  ///< by rising time; empty at the end
};

/// What else a seed's site may be drawn as; SimOptions says what each means.
struct SiteStyle {
  int world = 1;
  sim::SensorModel lidar_sensor = sim::SensorModel::l515, device_sensor = sim::SensorModel::l515;
};

/// The site that a seed stands for: 40 to 400 m2, tidy to cluttered, 0 to 12 people; offices, corridors, halls,
/// and rooms that look the same after half a turn; devices carried and driven. World
/// 2 has fewer LiDARs.
[[nodiscard]] sim::SimOptions site_options(std::uint64_t seed, double seconds, const SiteStyle& style = {});

[[nodiscard]] Result<Stage> simulated_stage(std::uint64_t seed, double seconds, const SiteStyle& style = {});
/// Every device with a ground truth takes part. Errors: the recording cannot be read, no device has one.
[[nodiscard]] Result<Stage> recorded_stage(const std::string& folder);

}  // namespace liloc::bench
