#pragma once
// One moment of the room: the ceiling frames, the stitched cloud, and what registration needs of it, built once.
#include <memory>
#include <mutex>
#include <vector>

#include "common/geometry/camera.hpp"
#include "common/geometry/depth.hpp"
#include "common/registration/feature_search.hpp"
#include "common/registration/target.hpp"

namespace liloc {

struct SnapshotOptions {
  double voxel_size_m = 0.05;
  DepthOptions depth;
  int view_factor = 2;          ///< pixels of a ceiling image per pixel of its line-of-sight view
  double feature_sampling = 0.5;  ///< share of the thinned GPC's points that get a descriptor
};

/// A ceiling LiDAR's frame. Immutable; what is derived from it alone is derived when first asked for and shared by
/// all snapshots that hold the frame. Any thread may ask.
class LidarFrame {
 public:
  /// `lidar` outlives the frame; the image's size is the camera's.
  LidarFrame(DepthImage image, const GlobalLidar& lidar, const SnapshotOptions& options);

  [[nodiscard]] StampNs stamp_ns() const { return image_.stamp_ns; }
  [[nodiscard]] const GlobalLidar& lidar() const { return lidar_; }
  /// Voxelized, map frame, normals towards the sensor.
  [[nodiscard]] const Cloud& cloud_map() const;
  [[nodiscard]] const SightView& view() const;

 private:
  void derive() const;

  const DepthImage image_;
  const GlobalLidar& lidar_;
  const SnapshotOptions options_;
  mutable std::once_flag once_;
  mutable Cloud cloud_map_;
  mutable SightView view_;
};

/// Immutable; shared by all clients whose requests fall on it.
class Snapshot {
 public:
  Snapshot(StampNs stamp_ns, std::vector<std::shared_ptr<const LidarFrame>> frames, const SnapshotOptions& options);

  [[nodiscard]] StampNs stamp_ns() const { return stamp_ns_; }
  [[nodiscard]] const std::vector<std::shared_ptr<const LidarFrame>>& frames() const { return frames_; }
  /// The stitched GPC and its indices; the first caller builds them.
  [[nodiscard]] const Target& target() const;
  /// Descriptors of the thinned GPC; the first caller computes them.
  [[nodiscard]] const Described& described() const;

 private:
  const StampNs stamp_ns_;
  const std::vector<std::shared_ptr<const LidarFrame>> frames_;
  const SnapshotOptions options_;
  mutable std::once_flag target_once_, described_once_;
  mutable Target target_;
  mutable Described described_;
};

}  // namespace liloc
