#pragma once
// A simulated site whose streams can be spoilt while they run over DDS.
#include <array>
#include <atomic>
#include <map>
#include <memory>
#include <mutex>
#include <thread>

#include "common/wire/ros/ros_publishers.hpp"
#include "common/wire/sensors/sensor_publishers.hpp"
#include "proto-tests/sim/simulation.hpp"

namespace liloc::inputs {

/// What is done to samples as they leave, by LiDAR and by device. Any thread.
struct Spoil {
  std::array<std::atomic<StampNs>, 8> lidar_ahead_ns{};  ///< of each one's clock
  std::array<std::atomic<void (*)(DepthImage&)>, 8> lidar_image{}, device_image{};
  std::array<std::atomic<void (*)(ImuSample&)>, 8> imu{};
  std::atomic<StampNs> device_ahead_ns = 0;                     ///< of the clock of all devices
  std::atomic<bool> devices_silent = false;                     ///< no sample of a device leaves
  std::array<std::atomic<bool>, 8> stray_frame{}, stray_imu{};  ///< the next one is stamped an hour ahead
  std::atomic<bool> stray_odometry = false;                     ///< likewise
};

/// Streams in real time, on a thread of its own, with stamps of this host's clock. Each device
/// sends an IMU and depth, but the second clouds in place of images, and the third odometry beside them.
class PlayedSite {
 public:
  /// Joins the domains as their source of streams. Errors: the options, DDS.
  [[nodiscard]] static Result<std::unique_ptr<PlayedSite>> start(sim::SimOptions options,
                                                                 const std::vector<int>& domains);

  ~PlayedSite();
  PlayedSite(const PlayedSite&) = delete;
  PlayedSite& operator=(const PlayedSite&) = delete;

  [[nodiscard]] const Site& site() const { return site_; }
  [[nodiscard]] const std::vector<DeviceInfo>& devices() const { return devices_; }
  /// Writes FOLDER/site.json and FOLDER/<device>.json, as server and clients read them.
  [[nodiscard]] Status describe(const std::filesystem::path& folder) const;
  /// Where a device was at one of its frames, by the stamp that this carried.
  [[nodiscard]] std::optional<Pose> truth(std::size_t device, StampNs stamp_ns) const;
  /// The first error of sending, if any.
  [[nodiscard]] Status trouble() const;

  Spoil spoil;

 private:
  struct Outlet;
  PlayedSite(sim::Simulation simulation, std::vector<Outlet> outlets);
  void run(const std::stop_token& stop);
  [[nodiscard]] Status send(sim::SimEvent& event);
  [[nodiscard]] Status send(sim::LidarFrame& frame);
  [[nodiscard]] Status send(sim::DeviceFrame& frame);
  [[nodiscard]] Status send(sim::DeviceImu& imu);

  sim::Simulation simulation_;
  const Site site_;  ///< copies: the simulation belongs to the thread
  const std::vector<DeviceInfo> devices_;
  std::vector<Outlet> outlets_;  ///< of each domain
  mutable std::mutex mutex_;     ///< guards what follows
  std::vector<std::map<StampNs, Pose>> truths_;
  Status trouble_;
  std::jthread worker_;  ///< last: it ends before what it uses
};

}  // namespace liloc::inputs
