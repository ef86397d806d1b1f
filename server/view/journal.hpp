#pragma once
// What devices were answered lately: where each one is, where it was, and the cloud of one that was not
// located.
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "common/protocol/spot.hpp"
#include "server/view/outcome_chart.hpp"

namespace liloc::view {

/// By hand: each device is drawn, and its trail lasts a minute.
constexpr std::size_t kDevicesKept = 512, kTrailKept = 75, kScansKept = 64, kScanBytes = 256 * 1024;

/// A device as its answers tell.
struct DeviceState {
  SpotReply last;  ///< its newest answer
  /// The last pose that it was told, and of that answer; empty before the first.
  std::optional<Pose> T_map_sensor;
  Matrix6d covariance = Matrix6d::Zero();  ///< as SpotReply::covariance
  bool pose_verified = false;
  double confidence = 0;  ///< of the last answer that the localizer gave
  std::vector<Eigen::Vector3f>
      trail_map;  ///< where it was verified to be, the oldest first; at most kTrailKept
  std::uint64_t answers = 0;
  std::optional<std::uint64_t> scan_seq;  ///< of the cloud that is kept of it
  std::chrono::steady_clock::time_point at;
};

/// The cloud of a request that was not verified, and where it is best drawn.
struct UnlocatedScan {
  std::uint64_t seq = 0;
  EncodedCloud cloud_sensor;
  std::optional<Pose>
      T_map_sensor;  ///< this answer's own guess, else where odometry carried the last verified one
};

/// Thread-safe; its lock is held for microseconds, as workers wait for it. Bounded: the devices heard longest
/// ago are forgotten first.
class Journal {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// A worker has an answer of the localizer. Keeps a copy of the cloud where it is not verified.
  void located(const SpotRequest& request, const SpotReply& reply);
  /// Any answer, as it leaves; after `located` for the same request.
  void answered(const SpotReply& reply, Time at);
  void forget(const std::string& client_id);
  /// All devices; the chart stays.
  void forget_all();

  /// By id; without those heard over a minute ago.
  [[nodiscard]] std::vector<std::shared_ptr<const DeviceState>> devices(Time now) const;
  [[nodiscard]] std::shared_ptr<const UnlocatedScan> scan_of(const std::string& client_id) const;
  [[nodiscard]] std::vector<ChartColumn> columns(Time now) const;

 private:
  struct Odometry {  ///< where the map lies, as a device was last verified
    std::uint32_t segment = 0;
    Pose T_map_odom = Pose::Identity();
  };
  struct Entry {
    std::shared_ptr<const DeviceState> state;
    std::shared_ptr<const UnlocatedScan> scan;
    std::optional<Odometry> odometry;
    Time at{};
  };
  Entry& entry_of(const std::string& client_id, Time at);  ///< mutex_ held
  void bound_scans();                                      ///< mutex_ held

  mutable std::mutex mutex_;
  std::map<std::string, Entry> entries_;
  OutcomeChart chart_;
};

}  // namespace liloc::view
