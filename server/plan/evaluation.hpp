#pragma once
// What a set of ceiling LiDARs is worth in a room.
#include <string>
#include <vector>

#include "server/plan/coverage.hpp"

namespace liloc::plan {

/// A LiDAR where it hangs or may hang.
struct HungLidar {
  std::string id;
  Camera camera;
  double range_m = kLidarRange_m;
  Pose T_map_sensor = Pose::Identity();
};

struct LidarWorth {
  double coverage = 0;  ///< share of the room's voxels that it sees alone
  double hit_rate = 0;  ///< of the views that any LiDAR sees, those that it sees most of (paper, section 7.1.2)
  double lost = 0;      ///< share of localizable views that would be lost without it
};

struct Evaluation {
  double coverage = 0;               ///< share of the room's voxels that some LiDAR sees
  double localizable = 0;            ///< mean chance over all views
  double overlap = 0;                ///< mean share of a view's surfaces that the ceiling sees
  double blind_m2 = 0;               ///< floor of places where no direction reaches `kBlindChance`
  std::vector<double> chances;       ///< per view
  std::vector<double> overlaps;      ///< per view
  std::vector<double> place_chance;  ///< per place: mean over heights and directions
  std::vector<bool> blind;           ///< per place
  std::vector<LidarWorth> lidars;    ///< in their order
  std::vector<bool> covered;         ///< per voxel
};

constexpr double kBlindChance = 0.25;  ///< of the best direction at a place; by hand
constexpr double kTwinAlike = 0.9;     ///< of Twin::alike: two places that are drawn as twins; by hand

/// Deterministic. `lidars` may be empty.
[[nodiscard]] Evaluation evaluate(const VoxelRoom& room, const FreeFloor& floor, const DeviceViews& devices,
                                  const std::vector<HungLidar>& lidars);

}  // namespace liloc::plan
