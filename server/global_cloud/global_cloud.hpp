#pragma once
// The room as the ceiling sees it now: the newest frames of every LiDAR, and immutable snapshots of them.
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/geometry/camera.hpp"
#include "common/geometry/depth.hpp"
#include "server/global_cloud/background.hpp"
#include "server/global_cloud/snapshot.hpp"

namespace liloc {

/// Defaults are by hand where nothing else is said.
struct GlobalCloudOptions {
  SnapshotOptions snapshot;
  BackgroundOptions background;
  bool drop_moving = true;               ///< what moves is not map: it neither registers nor contradicts
  StampNs keep_ns = from_seconds(3.0);   ///< frames older than the newest by more than this are forgotten
  StampNs renew_ns = from_seconds(4.0);  ///< small changes of the room are gathered for so long
  /// A room's surfaces are indexed anew no sooner; until then lines of sight tell what has changed. The longer
  /// the more rooms sessions still hold, so that memory stays bounded.
  StampNs least_renewal_ns = from_ms(100.0);
  StampNs match_ns = from_ms(100.0);  ///< farther from a request than this is no GPC (paper, section 5.3.1)
  std::size_t max_frames_per_lidar = 128;  ///< a LiDAR that floods loses its oldest
};

/// Thread-safe. Frames come from ingest threads, snapshots are asked for by workers and shared by all clients.
class GlobalCloud {
 public:
  GlobalCloud(Site site, GlobalCloudOptions options);

  /// Takes a depth frame of LiDAR `lidar` (index into the site). Errors: the size differs from the site's, a
  /// stamp that is not newer than the LiDAR's last. The frame is then left out and nothing changes; but when
  /// several in a row are older than anything that is kept, its clock was set back, and it begins anew.
  [[nodiscard]] Status add_depth(std::size_t lidar, DepthImage image);
  /// The same for a LiDAR that streams points (sensor frame): they are rendered into its camera.
  [[nodiscard]] Status add_points(std::size_t lidar, StampNs stamp_ns, const Cloud& cloud_sensor);

  /// The snapshot nearest to `stamp_ns`: of each LiDAR the frame nearest to it, if within `match_ns`.
  /// Error: no LiDAR has one.
  [[nodiscard]] Result<std::shared_ptr<const Snapshot>> nearest(StampNs stamp_ns);

  /// Of each LiDAR its newest frame, but for those that fell silent; null before the first frame. Builds
  /// nothing.
  [[nodiscard]] std::shared_ptr<const Snapshot> newest();

  /// Builds the newest snapshot, so that no request has to wait for it: the room's indices if it has changed,
  /// what moves, and the lines of sight. Costs nothing until there is a newer frame; descriptors are made only
  /// while some request lately asked for them. Called by a thread of its own.
  void prepare();

  [[nodiscard]] const Site& site() const { return site_; }
  /// How far a frame may be from a request's stamp.
  [[nodiscard]] StampNs match_ns() const { return options_.match_ns; }

  /// What an earlier run learned of each LiDAR, in the site's order; before the first frame.
  void set_known_noise(const std::vector<DepthNoise>& known);
  /// What is known by now, in the site's order.
  [[nodiscard]] std::vector<DepthNoise> noise() const;

 private:
  using Frame = std::shared_ptr<const LidarFrame>;

  /// What stands still before a LiDAR, and the surfaces derived from it last. Its lock keeps the LiDAR's frames
  /// in turn while they are learned from, which requests need not wait for; taken before `mutex_`.
  struct Watch {
    explicit Watch(Background empty) : background(std::move(empty)) {}
    mutable std::mutex mutex;
    Background background;
    std::shared_ptr<const LidarSurfaces> surfaces;
    std::optional<StampNs> last_ns;
    int epoch = 0;
    int late = 0;  ///< frames in a row that are older than anything kept
  };
  [[nodiscard]] bool clock_set_back(std::size_t lidar, StampNs stamp_ns);  ///< the watch's lock held
  [[nodiscard]] Frame watched(std::size_t lidar, DepthImage image);        ///< the watch's lock held
  [[nodiscard]] int epoch_after(Change change, StampNs stamp_ns);
  void keep(std::size_t lidar, Frame frame);
  [[nodiscard]] std::shared_ptr<const StitchedRoom> room_of(const std::vector<Frame>& frames);  ///< mutex_ held
  [[nodiscard]] std::shared_ptr<const Snapshot> snapshot_of(std::vector<Frame> frames);         ///< mutex_ held
  [[nodiscard]] std::shared_ptr<const Snapshot> newest_held();                                  ///< mutex_ held
  [[nodiscard]] bool worth_describing(const std::shared_ptr<const StitchedRoom>& room);         ///< mutex_ held
  [[nodiscard]] Frame nearest_frame(std::size_t lidar, StampNs stamp_ns) const;  ///< null: none; mutex_ held

  const Site site_;
  const GlobalCloudOptions options_;
  std::deque<Watch> watches_;              ///< per LiDAR
  mutable std::mutex mutex_;               ///< of all below
  std::vector<std::deque<Frame>> frames_;  ///< per LiDAR, by rising stamp
  int epoch_ =
      0;  ///< raised when small changes have gathered: all LiDARs then renew together, at one rebuild's cost
  StampNs epoch_since_ns_ = 0;
  std::deque<std::shared_ptr<const Snapshot>> snapshots_;    ///< asked for lately, newest last
  std::deque<std::shared_ptr<const StitchedRoom>> rooms_;    ///< of them
  std::deque<std::weak_ptr<const StitchedRoom>> all_rooms_;  ///< also those that only sessions hold
  std::shared_ptr<const StitchedRoom> prepared_;             ///< newest
  int describe_ahead_ = 0;  ///< so many rooms more get their descriptors before anyone asks for them
};

}  // namespace liloc
