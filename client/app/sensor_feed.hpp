#pragma once
#include <chrono>
#include <string>

#include "client/app/options.hpp"
#include "common/geometry/camera.hpp"
#include "common/wire/dispatcher.hpp"
#include "common/wire/sensors.hpp"

namespace liloc {

/// Hands what comes on a device's sensor topics to the client. After `subscribe` it is the dispatcher's
/// thread's alone, and has to outlive the dispatcher.
class SensorFeed {
 public:
  /// `client` outlives this.
  SensorFeed(const DaemonOptions& options, client::Client& client) : options_(options), client_(client) {}

  /// To the topics that the options name. Errors: those of DDS.
  [[nodiscard]] Status subscribe(wire::Dispatcher& sensors);

 private:
  [[nodiscard]] Status subscribe_frames(wire::Dispatcher& sensors);
  void take_depth(const Result<DepthImage>& image);
  void take_points(const Result<wire::StampedCloud>& cloud);
  void take_odometry(const Result<wire::StampedOdometry>& odometry);
  void take_imu(const Result<ImuSample>& sample);
  void check_camera(const Camera& camera);
  void complain(const std::string& what);

  const DaemonOptions options_;
  client::Client& client_;
  std::uint64_t refused_ = 0;
  std::chrono::steady_clock::time_point complained_{};
  bool camera_differs_ = false, frame_differs_ = false;
};

}  // namespace liloc
