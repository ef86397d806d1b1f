#pragma once
// The paper's study of placement (section 3.1.4), on the room at hand.
#include <vector>

#include "server/plan/evaluation.hpp"
#include "server/plan/mounts.hpp"

namespace liloc::plan {

struct HeightRow {  ///< Table 2
  double above_floor_m = 0;
  double coverage = 0, localizable = 0;  ///< of all LiDARs at that height, level where it is a person's
  std::size_t voxels = 0;                ///< that they see
};
struct TiltRow {  ///< Table 3
  double down_deg = 0;
  double overlap = 0;      ///< of what a LiDAR sees at any tilt, what it sees at this one; mean over LiDARs
  double localizable = 0;  ///< of all LiDARs at that tilt
};
struct CountRow {  ///< Figure 7
  std::size_t lidars = 0;
  double least = 0, mean = 0, most = 0;  ///< coverage over the choices of so many of the LiDARs
};

struct Study {
  std::vector<HeightRow> heights;
  std::vector<TiltRow> tilts;
  std::vector<CountRow> counts;
};

/// Takes LiDARs where they hang, and changes one thing at a time. `on_progress` is told the share that is done.
/// Deterministic. At least one LiDAR.
[[nodiscard]] Study study_placement(const VoxelRoom& room, const FreeFloor& floor, const DeviceViews& devices,
                                    const std::vector<HungLidar>& lidars,
                                    const std::function<void(double)>& on_progress);

}  // namespace liloc::plan
