#pragma once
// A proposal of where ceiling LiDARs should hang: greedy, then swaps, then small moves.
#include "server/plan/coverage.hpp"
#include "server/plan/mounts.hpp"

namespace liloc::plan {

constexpr int kMostLidars = 32;  ///< of a plan; by hand

struct LidarModel {
  Camera camera;
  double range_m = kLidarRange_m;
};

struct PlacementOptions {
  int lidars = 3;  ///< 1..kMostLidars
  MountOptions mounts;
  int swap_rounds = 2;  ///< by hand: a third changes nothing on most sites
  int move_rounds = 2;  ///< by hand
};

/// The mounts that make the most device views localizable (Coverage::localizable_share), as far as the search
/// finds them. `on_progress` is told the share that is done. Deterministic for a seed. Errors: nothing can hang
/// anywhere.
[[nodiscard]] Result<std::vector<Mount>> place_lidars(const VoxelRoom& room, const FreeFloor& floor,
                                                      const DeviceViews& devices, const LidarModel& lidar,
                                                      const PlacementOptions& options,
                                                      const std::function<void(double)>& on_progress);

}  // namespace liloc::plan
