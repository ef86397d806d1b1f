#pragma once
// A furnished site with people, ceiling LiDARs and devices, as a stream of what its sensors deliver. The same
// stream fills a recording (write_recording.hpp) or a live site.
#include <memory>
#include <optional>
#include <variant>
#include <vector>

#include "common/geometry/camera.hpp"
#include "common/geometry/cloud.hpp"
#include "common/recording/recording.hpp"
#include "proto-tests/sim/base/options.hpp"

namespace liloc::sim {

struct LidarFrame {
  std::size_t lidar = 0;  ///< index into site().global_lidars
  DepthImage image;
};
struct DeviceFrame {
  std::size_t device = 0;                ///< index into devices()
  DepthImage image;                      ///< stamped by the device's clock
  Pose T_map_sensor = Pose::Identity();  ///< the truth
};
struct DeviceImu {
  std::size_t device = 0;
  ImuSample sample;  ///< stamped by the device's clock
};

struct SimEvent {
  StampNs at_ns = 0;  ///< when it happens, by the site's clock
  std::variant<LidarFrame, DeviceFrame, DeviceImu> payload;
};

class Simulation {
 public:
  /// Draws the site and everyone's ways. Errors: an option out of range, a site too crammed to walk in, no
  /// Embree.
  [[nodiscard]] static Result<Simulation> create(const SimOptions& options);
  Simulation(Simulation&&) noexcept;
  Simulation& operator=(Simulation&&) noexcept;
  ~Simulation();

  [[nodiscard]] const SimOptions& options() const;
  [[nodiscard]] const Site& site() const;
  [[nodiscard]] const std::vector<DeviceInfo>& devices() const;
  [[nodiscard]] StampNs start_ns() const;

  /// The next event by rising time, rendered now; empty after `seconds`. One thread at a time.
  [[nodiscard]] std::optional<SimEvent> next();

  /// Leaves out the images that would come before a moment, unseen and unrendered, for whoever has fallen
  /// behind; IMU samples cost nothing and stay. How many.
  std::size_t skip_images_before(StampNs at_ns);

  /// A scan of the empty site before anything was moved, in the map frame, about a point every 4 cm.
  [[nodiscard]] Result<Cloud> reference_scan() const;

  /// Where a device is at a time since the start, and what an errorless IMU would read. For tests.
  [[nodiscard]] Pose T_map_sensor(std::size_t device, double time_s) const;
  [[nodiscard]] ImuSample exact_imu(std::size_t device, double time_s) const;

 private:
  struct Impl;
  explicit Simulation(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace liloc::sim
