#pragma once
// The sensors of a site as ROS 2 topics: what a recording, a simulation and the demo send.
#include <vector>

#include "common/recording/recording.hpp"
#include "common/wire/sensors/sensor_publishers.hpp"

namespace liloc::replay {

/// Publishers for every ceiling LiDAR and device. Movable; `participant` must outlive it.
class Streams {
 public:
  [[nodiscard]] static Result<Streams> create(const wire::Participant& participant, const Site& site,
                                              const std::vector<DeviceInfo>& devices);

  [[nodiscard]] Status ceiling(std::size_t lidar, const DepthImage& image) const;
  [[nodiscard]] Status device(std::size_t device, const DepthImage& image) const;
  [[nodiscard]] Status imu(std::size_t device, const ImuSample& sample) const;

  /// Everyone who is to hear the streams does: each depth stream, and the IMU of each device that has one.
  [[nodiscard]] bool all_heard() const;

 private:
  struct Device {
    wire::DepthPublisher depth;
    std::optional<wire::ImuPublisher> imu;
  };
  std::vector<wire::DepthPublisher> ceiling_;
  std::vector<Device> devices_;
};

}  // namespace liloc::replay
