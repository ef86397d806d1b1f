#pragma once
// The same streams, written: by `liloc sim --live`, by `liloc replay`, and by a client that tells ROS its pose.
//
//   auto depth = wire::DepthPublisher::create(participant, "ceiling0", lidar.camera);
//   depth->publish(image);   // image and camera info, same stamp
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/camera.hpp"
#include "common/geometry/cloud.hpp"
#include "common/wire/entity.hpp"
#include "common/wire/participant.hpp"

namespace liloc::wire {

class DepthPublisher {
 public:
  [[nodiscard]] static Result<DepthPublisher> create(const Participant& participant, const std::string& id,
                                                     const Camera& camera);
  /// 16UC1 in the image's own units. Error: the size differs from the camera's.
  [[nodiscard]] Status publish(const DepthImage& image) const;
  /// Subscribers of the image that are matched now.
  [[nodiscard]] int readers() const;

 private:
  DepthPublisher() = default;
  std::string frame_id_;
  Camera camera_;
  Entity image_, info_;
};

class PointsPublisher {
 public:
  [[nodiscard]] static Result<PointsPublisher> create(const Participant& participant, const std::string& id);
  [[nodiscard]] Status publish(StampNs stamp_ns, const Cloud& cloud_sensor) const;
  [[nodiscard]] int readers() const;

 private:
  PointsPublisher() = default;
  std::string frame_id_;
  Entity writer_;
};

class ImuPublisher {
 public:
  [[nodiscard]] static Result<ImuPublisher> create(const Participant& participant, const std::string& id);
  [[nodiscard]] Status publish(const ImuSample& sample) const;
  [[nodiscard]] int readers() const;

 private:
  ImuPublisher() = default;
  std::string frame_id_;
  Entity writer_;
};

/// Where a device is, for ROS: rt/<id>/pose (PoseWithCovarianceStamped in the map), rt/<id>/odom (Odometry),
/// and rt/tf with map -> <id>/odom -> <id>/depth_optical_frame.
class PosePublisher {
 public:
  [[nodiscard]] static Result<PosePublisher> create(const Participant& participant, const std::string& id,
                                                    const std::string& world_frame = "map");
  /// `covariance` of T_map_sensor as in SpotReply: sensor frame, [rad; m].
  [[nodiscard]] Status publish_pose(StampNs stamp_ns, const Pose& T_map_sensor,
                                    const Matrix6d& covariance) const;
  [[nodiscard]] Status publish_odometry(StampNs stamp_ns, const Pose& T_odom_sensor) const;
  /// Transforms for tf; `T_map_odom` only once it is known.
  [[nodiscard]] Status publish_tf(StampNs stamp_ns, const std::optional<Pose>& T_map_odom,
                                  const Pose& T_odom_sensor) const;

 private:
  PosePublisher() = default;
  std::string world_frame_, odom_frame_, sensor_frame_;
  Entity pose_, odometry_, tf_;
};

}  // namespace liloc::wire
