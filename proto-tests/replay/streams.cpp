#include "proto-tests/replay/streams.hpp"

#include <algorithm>

#include "common/base/distinct_topics.hpp"

namespace liloc::replay {

Result<Streams> Streams::create(const wire::Participant& participant, const Site& site,
                                const std::vector<DeviceInfo>& devices) {
  std::vector<std::string> ids;
  for (const GlobalLidar& lidar : site.global_lidars) ids.push_back(lidar.id);
  for (const DeviceInfo& info : devices) ids.push_back(info.id);
  if (const Status distinct = check_distinct_topics(ids); !distinct) return tl::unexpected(distinct.error());
  Streams streams;
  for (const GlobalLidar& lidar : site.global_lidars) {
    auto depth = wire::DepthPublisher::create(participant, lidar.id, lidar.camera);
    if (!depth) return tl::unexpected(depth.error());
    streams.ceiling_.push_back(std::move(*depth));
  }
  for (const DeviceInfo& info : devices) {
    auto depth = wire::DepthPublisher::create(participant, info.id, info.camera);
    if (!depth) return tl::unexpected(depth.error());
    streams.devices_.push_back({std::move(*depth), std::nullopt});
    if (!info.T_imu_sensor) continue;
    auto imu = wire::ImuPublisher::create(participant, info.id);
    if (!imu) return tl::unexpected(imu.error());
    streams.devices_.back().imu = std::move(*imu);
  }
  return streams;
}

Status Streams::ceiling(std::size_t lidar, const DepthImage& image) const {
  return ceiling_[lidar].publish(image);
}

Status Streams::device(std::size_t device, const DepthImage& image) const {
  return devices_[device].depth.publish(image);
}

Status Streams::imu(std::size_t device, const ImuSample& sample) const {
  const auto& publisher = devices_[device].imu;
  return publisher ? publisher->publish(sample) : Status{};
}

bool Streams::all_heard() const {
  return std::all_of(ceiling_.begin(), ceiling_.end(), [](const auto& depth) { return depth.readers() > 0; }) &&
         std::all_of(devices_.begin(), devices_.end(), [](const Device& device) {
           return device.depth.readers() > 0 && (!device.imu || device.imu->readers() > 0);
         });
}

}  // namespace liloc::replay
