#pragma once
// One moment of the room: what each ceiling LiDAR sees, and the surfaces that this moment shares with its
// neighbours.
#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

#include "common/geometry/camera.hpp"
#include "common/geometry/depth.hpp"
#include "common/registration/search/feature_search.hpp"
#include "common/registration/target/target.hpp"
#include "server/global_cloud/layers.hpp"

namespace liloc {

/// Defaults are by hand where nothing else is said.
struct SnapshotOptions {
  double voxel_size_m = 0.05;  ///< paper, section 3.1.5
  DepthOptions depth;
  int view_factor = 2;  ///< pixels of a ceiling image per pixel of its line-of-sight view
  /// Share of the thinned GPC's points that get a descriptor (paper, section 5.2).
  double feature_sampling = 0.5;
  Describer describer = {};  ///< empty: FPFH
};

/// The surfaces before one LiDAR, as long as they do not change: shared by all frames of that time. The cloud
/// is derived when first asked for. Immutable; any thread may ask.
class LidarSurfaces {
 public:
  /// `lidar` outlives this; the image's size is the camera's.
  LidarSurfaces(DepthImage image, const GlobalLidar& lidar, const SnapshotOptions& options);

  /// Voxelized, map frame, normals towards the sensor.
  [[nodiscard]] const Cloud& cloud_map() const;
  [[nodiscard]] SightView view() const;
  [[nodiscard]] const GlobalLidar& lidar() const { return lidar_; }
  [[nodiscard]] const DepthImage& image() const { return image_; }
  /// Of earlier surfaces before the same LiDAR, those that it has no more, thinned.
  [[nodiscard]] Cloud missing_of(const LidarSurfaces& before) const;

 private:
  const DepthImage image_;
  const GlobalLidar& lidar_;
  const SnapshotOptions options_;
  mutable std::once_flag once_;
  mutable Cloud cloud_map_;
};

/// A ceiling LiDAR's frame: its surfaces, and its lines of sight at this very moment, past everything that
/// moves.
class LidarFrame {
 public:
  LidarFrame(Layers layers, std::shared_ptr<const LidarSurfaces> surfaces, const GlobalLidar& lidar,
             const SnapshotOptions& options);

  [[nodiscard]] StampNs stamp_ns() const { return layers_.still.stamp_ns; }
  [[nodiscard]] const GlobalLidar& lidar() const { return lidar_; }
  [[nodiscard]] const std::shared_ptr<const LidarSurfaces>& surfaces() const { return surfaces_; }
  /// What it was made of.
  [[nodiscard]] const Layers& layers() const { return layers_; }
  [[nodiscard]] const SightView& view() const;
  /// What moves in this frame, thinned.
  [[nodiscard]] const Cloud& moving_map() const;
  /// Surfaces that were there until just now, thinned.
  [[nodiscard]] const Cloud& gone_map() const;

 private:
  const Layers layers_;
  const std::shared_ptr<const LidarSurfaces> surfaces_;
  const GlobalLidar& lidar_;
  const SnapshotOptions options_;
  mutable std::once_flag once_, moving_once_, gone_once_;
  mutable SightView view_;
  mutable Cloud moving_map_, gone_map_;
};

/// The GPC stitched from the surfaces of all LiDARs, with its indices and descriptors, each built by its first
/// user.
class StitchedRoom {
 public:
  using Parts = std::vector<std::shared_ptr<const LidarSurfaces>>;
  /// `before`: a room of a moment ago, whose indices may serve for this one's, or null. `stamp_ns`: of the
  /// newest frame that it was made for.
  StitchedRoom(Parts parts, const SnapshotOptions& options, std::weak_ptr<const StitchedRoom> before = {},
               StampNs stamp_ns = 0)
      : parts_(std::move(parts)), options_(options), before_(std::move(before)), stamp_ns_(stamp_ns) {}

  [[nodiscard]] const Parts& parts() const { return parts_; }
  [[nodiscard]] StampNs stamp_ns() const { return stamp_ns_; }
  [[nodiscard]] const std::shared_ptr<const Surfaces>& surfaces() const;
  [[nodiscard]] const Described& described() const;
  [[nodiscard]] bool has_descriptors() const { return has_descriptors_; }
  /// Whether a request has asked for descriptors.
  [[nodiscard]] bool descriptors_asked() const { return descriptors_asked_; }
  void note_descriptors_asked() const { descriptors_asked_ = true; }
  /// What is up in the map frame: z in a site that is set up as it should be.
  [[nodiscard]] const Eigen::Vector3d& up_map() const;
  /// Builds all of it now, descriptors if `describe`, so that no request has to. Costs nothing the second time.
  void prepare(bool describe) const;

 private:
  const Parts parts_;
  const SnapshotOptions options_;
  const std::weak_ptr<const StitchedRoom> before_;  ///< weak: rooms must not keep all that came before them
  const StampNs stamp_ns_;
  mutable std::once_flag surfaces_once_, described_once_, up_once_;
  mutable Eigen::Vector3d up_map_ = Eigen::Vector3d::UnitZ();
  mutable std::shared_ptr<const Surfaces> surfaces_;
  mutable Described described_;
  mutable std::atomic<bool> has_surfaces_ = false, has_descriptors_ = false, descriptors_asked_ = false;
};

/// Immutable; shared by all clients whose requests fall on it.
class Snapshot {
 public:
  using Frames = std::vector<std::shared_ptr<const LidarFrame>>;
  /// At least one frame.
  Snapshot(Frames frames, std::shared_ptr<const StitchedRoom> room)
      : frames_(std::move(frames)), room_(std::move(room)) {}

  /// The stamp of its frame nearest to a moment.
  [[nodiscard]] StampNs stamp_near(StampNs stamp_ns) const;
  [[nodiscard]] const Frames& frames() const { return frames_; }
  [[nodiscard]] const std::shared_ptr<const StitchedRoom>& room() const { return room_; }
  /// The GPC and the ceiling's lines of sight; the first caller builds what is not built yet.
  [[nodiscard]] const Target& target() const;
  [[nodiscard]] bool has_target() const { return has_target_; }
  /// Descriptors of the thinned GPC.
  [[nodiscard]] const Described& described() const {
    room_->note_descriptors_asked();
    return room_->described();
  }

 private:
  const Frames frames_;
  const std::shared_ptr<const StitchedRoom> room_;
  mutable std::once_flag once_;
  mutable Target target_;
  mutable std::atomic<bool> has_target_ = false;
};

}  // namespace liloc
