#pragma once
// The same streams, written: by `liloc sim --live` and by `liloc replay`.
//
//   auto depth = wire::DepthPublisher::create(participant, "ceiling0", lidar.camera);
//   depth->publish(image);   // image and camera info, same stamp
#include <string>
#include <vector>

#include "common/geometry/camera.hpp"
#include "common/geometry/cloud.hpp"
#include "common/wire/dds/entity.hpp"
#include "common/wire/dds/participant.hpp"

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
  /// On any topic, named as on the wire.
  [[nodiscard]] static Result<PointsPublisher> create_at(const Participant& participant,
                                                         const std::string& topic, const std::string& frame_id);
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

}  // namespace liloc::wire
