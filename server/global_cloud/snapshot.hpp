#pragma once
// One moment of the room: the ceiling frames, the stitched cloud, and what registration needs of it, built once.
#include <memory>
#include <mutex>
#include <vector>

#include "common/geometry/camera.hpp"
#include "common/geometry/cloud.hpp"
#include "common/geometry/depth.hpp"

namespace liloc {

struct SnapshotOptions {
  double voxel_size_m = 0.05;
  DepthOptions depth;
};

/// A ceiling LiDAR's frame and what is derived from it alone. Immutable; shared by the snapshots that hold it.
struct LidarFrame {
  DepthImage image;
  const GlobalLidar* lidar = nullptr;  ///< of the site, which outlives all frames
};

class Snapshot;

}  // namespace liloc
