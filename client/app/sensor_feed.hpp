#pragma once
#include <string>

#include "client/app/options.hpp"
#include "common/base/line_limit.hpp"
#include "common/geometry/camera.hpp"
#include "common/wire/dds/dispatcher.hpp"
#include "common/wire/sensors/sensors.hpp"

namespace liloc {

/// Hands what comes on a device's sensor topics to the client. After `subscribe` it is the dispatcher's
/// thread's alone, and has to outlive the dispatcher.
class SensorFeed {
 public:
  /// `client` outlives this.
  SensorFeed(const DaemonOptions& options, client::Client& client) : options_(options), client_(client) {}

  /// To the topics that the options name. Errors: those of DDS.
  [[nodiscard]] Status subscribe(wire::Dispatcher& sensors);

  /// What a topic brought, or why it cannot be used: told in the log, frames by the client.
  void take_depth(const Result<DepthImage>& image);
  void take_points(const Result<wire::StampedCloud>& cloud);
  void take_odometry(const Result<wire::StampedOdometry>& odometry);
  void take_imu(const Result<ImuSample>& sample);
  void take_camera_info(const Result<Camera>& camera);

 private:
  [[nodiscard]] Status subscribe_frames(wire::Dispatcher& sensors);
  void complain(const std::string& what);

  const DaemonOptions options_;
  client::Client& client_;
  LineLimit complaints_;  ///< a misconfigured driver sends a bad sample thirty times a second
  bool camera_unread_ = false, camera_differs_ = false, frame_differs_ = false;
};

}  // namespace liloc
