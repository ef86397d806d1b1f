#pragma once
// Where one can stand in a scanned room.
#include <optional>
#include <vector>

#include "server/plan/voxel_room.hpp"

namespace liloc::plan {

/// All by hand.
struct FloorOptions {
  double body_radius_m = 0.35;        ///< who carries a device needs so much
  double step_m = 0.2, head_m = 1.8;  ///< nothing stands or hangs between these heights above the floor
  std::size_t most_places = 120;      ///< of places that are looked from
};

struct FreeFloor {
  double floor_z_m = 0;                     ///< of the map
  std::optional<double> ceiling_z_m;        ///< none: the scan shows no ceiling
  double area_m2 = 0;                       ///< that one can stand on
  double spacing_m = 0;                     ///< of the places, a square grid
  std::vector<Eigen::Vector2f> places_map;  ///< on free floor, evenly spaced
};

/// The floor is the lowest level that a fifth of the room has, the ceiling the highest. Of free floor in parts
/// all count that are a fifth of the largest. Errors: no floor, no place to stand.
[[nodiscard]] Result<FreeFloor> find_free_floor(const VoxelRoom& room, const FloorOptions& options = {});

}  // namespace liloc::plan
