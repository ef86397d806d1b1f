#pragma once
// What devices would see of a room: from every standing place, at every height, in all directions.
#include <functional>
#include <vector>

#include "server/plan/free_floor.hpp"
#include "server/plan/sensor_rays.hpp"

namespace liloc::plan {

/// What a device is. By hand: a phone held before the chest and a robot, with a solid-state LiDAR's view.
struct DeviceModel {
  Camera camera;
  double range_m = 6;                       ///< along the ray, of what it sends
  std::vector<double> heights_m{1.1, 0.8};  ///< above the floor
  double down_rad = 0.06;                   ///< below the horizon
  static constexpr int kDirections = 8;     ///< evenly around
};

/// A pose of a device and what it sees there.
struct DeviceView {
  std::size_t place = 0;  ///< of FreeFloor::places_map
  int direction = 0;      ///< towards 2 pi / 8 * direction from map x
  Pose T_map_sensor = Pose::Identity();
  std::vector<Surface> seen;  ///< rising
};

/// Another pose of the room from which a device would see much the same.
struct Twin {
  std::size_t view = 0;  ///< index of the view that looks most alike
  double alike = 0;      ///< share of a coarse grid of ranges that are the same, 0..1
};

/// Immutable; any thread may read it.
struct DeviceViews {
  std::vector<DeviceView> views;
  std::vector<Twin> twins;  ///< per view
  /// Of each surface the views that see it: `viewers[viewers_of[s] .. viewers_of[s + 1]]`.
  std::vector<std::uint32_t> viewers, viewers_of;
};

/// A sensor at `from_map` that looks so far below the horizon. `azimuth_rad` from map x.
[[nodiscard]] Pose looking(const Eigen::Vector3d& from_map, double azimuth_rad, double down_rad);

/// `on_progress` is told the share that is done. Views of less than 30 surfaces count, and are never
/// localizable.
[[nodiscard]] DeviceViews look_around(const VoxelRoom& room, const FreeFloor& floor, const DeviceModel& device,
                                      const std::function<void(double)>& on_progress);

}  // namespace liloc::plan
