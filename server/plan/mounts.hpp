#pragma once
// Where a ceiling LiDAR can hang, and how it can look from there.
#include <vector>

#include "server/plan/device_views.hpp"

namespace liloc::plan {

struct Mount {
  Eigen::Vector3d at_map = Eigen::Vector3d::Zero();
  double azimuth_rad = 0;  ///< where it looks, from map x
  double down_rad = 0;     ///< below the horizon

  [[nodiscard]] Pose T_map_sensor() const { return looking(at_map, azimuth_rad, down_rad); }
};

/// All by hand: brackets under a ceiling, out of reach of people, off the walls.
struct MountOptions {
  double ceiling_z_m = 0;  ///< of the map
  std::vector<double> below_ceiling_m{0.15, 0.6};
  std::vector<double> down_deg{20, 30, 45, 60};  ///< the paper's tilt is 30 (section 3.1.4)
  int azimuths = 12;
  double lowest_m = 2.2;  ///< above the floor, where anything hangs higher
  double off_wall_m = 0.3;
  std::size_t most = 2500;  ///< drawn from all by the seed
  std::uint64_t seed = 1;
};

/// Whether a LiDAR can hang there: in free space within the room, and off the walls.
[[nodiscard]] bool can_hang(const VoxelRoom& room, const FreeFloor& floor, const Eigen::Vector3d& at_map,
                            double off_wall_m);

/// Along walls and, wider apart, below the rest of the ceiling; looking away from close walls. Deterministic.
/// May be empty.
[[nodiscard]] std::vector<Mount> possible_mounts(const VoxelRoom& room, const FreeFloor& floor,
                                                 const MountOptions& options);

}  // namespace liloc::plan
