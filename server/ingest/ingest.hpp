#pragma once
// The ceiling's streams over DDS, to frames. Each LiDAR may send depth images or points; one that falls silent
// and comes back is simply heard again.
//
//   auto ingest = Ingest::create(dispatcher, site, {.add_depth = ..., .add_points = ...});
//   dispatcher.start();
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <vector>

#include "common/geometry/camera.hpp"
#include "common/geometry/cloud.hpp"
#include "common/wire/dds/dispatcher.hpp"
#include "common/wire/spots/status.hpp"
#include "server/ingest/frame_content.hpp"
#include "server/ingest/site_clocks.hpp"

namespace liloc {

/// Where frames go; `lidar` is the index into the site. Run on the dispatcher's thread. An error counts as a
/// malformed frame. Stamps are the site's clock (`SiteClocks`); a frame whose clock cannot be set right does
/// not come here. `on_frame`, where set, follows each frame that was taken.
struct FrameSink {
  std::function<Status(std::size_t lidar, DepthImage)> add_depth = {};
  std::function<Status(std::size_t lidar, StampNs, const Cloud& cloud_sensor)> add_points = {};
  std::function<void()> on_frame = {};
};

class Ingest {
 public:
  /// Before the dispatcher starts; the dispatcher must be stopped before the ingest goes. The site is the
  /// calibration: a stream of another size is malformed, a camera_info that differs in focal length by over 1 %
  /// is warned of once.
  [[nodiscard]] static Result<std::unique_ptr<Ingest>> create(wire::Dispatcher& dispatcher, const Site& site,
                                                              FrameSink sink);
  ~Ingest();
  Ingest(const Ingest&) = delete;
  Ingest& operator=(const Ingest&) = delete;

  /// In the order of the site. Any thread.
  [[nodiscard]] std::vector<wire::LidarHealth> health() const;
  /// Since each LiDAR's newest good frame came, in the order of the site; empty before its first. Any thread.
  [[nodiscard]] std::vector<std::optional<double>> ages_s() const;
  /// What the ceiling's clock shows (`SiteClocks`), by the newest stamps and the time since they came; 0 where
  /// no LiDAR is heard. Any thread.
  [[nodiscard]] StampNs ceiling_now(std::chrono::steady_clock::time_point at) const;
  /// Up to which stamp every LiDAR that is heard has shown the room; empty where none is: nobody waits for
  /// one that is out. Any thread.
  [[nodiscard]] std::optional<StampNs> seen_until() const;

 private:
  struct Lidar;
  explicit Ingest(FrameSink sink);

  [[nodiscard]] Status subscribe(wire::Dispatcher& dispatcher, std::size_t index);
  /// Hands a frame on, stamped by the site's clock.
  void take(std::size_t index, StampNs stamp_ns, const FrameContent& content,
            const std::function<Status(StampNs)>& add);
  void drop(std::size_t index, const std::string& error);
  void check_camera(std::size_t index, const Result<Camera>& info);
  void report_changes();
  [[nodiscard]] wire::LidarHealth assess(std::size_t index, std::chrono::steady_clock::time_point now) const;

  const FrameSink sink_;
  mutable std::mutex mutex_;  // guards what changes in lidars_, and clocks_
  std::vector<std::unique_ptr<Lidar>> lidars_;
  SiteClocks clocks_{0};
};

}  // namespace liloc
