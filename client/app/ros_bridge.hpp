#pragma once
#include <mutex>
#include <optional>

#include "client/app/map_odom_slew.hpp"
#include "client/app/options.hpp"
#include "common/wire/ros/ros_publishers.hpp"

namespace liloc {

/// What the client tells ROS. Any thread.
class RosBridge {
 public:
  [[nodiscard]] static Result<std::unique_ptr<RosBridge>> create(const wire::Participant& participant,
                                                                 const DaemonOptions& options);

  /// A frame was processed: pose, odometry and transforms.
  void tell(const client::PoseUpdate& update);
  /// The state of the client as ROS's tools show it. `silent`: no frame came since the last call.
  void diagnose(const client::PoseUpdate& newest, const client::Stats& stats, bool silent);

 private:
  RosBridge(wire::RosPublisher publisher, const DaemonOptions& options);

  const std::string id_;
  const bool odometry_is_ours_;
  const StampNs ahead_ns_;
  const wire::RosPublisher publisher_;
  std::mutex mutex_;  ///< all below
  MapOdomSlew slew_;
};

/// What `diagnose` says: level, one line, and the figures.
[[nodiscard]] wire::Diagnosis diagnosis_of(const std::string& id, const client::PoseUpdate& newest,
                                           const client::Stats& stats, bool silent);

/// "searching", "tracking", "coasting", "lost".
[[nodiscard]] const char* name_of(client::State state);

}  // namespace liloc
