#pragma once
// A recording of two frames a sensor, sound in every file, for tests that then spoil one of them.
#include <gtest/gtest.h>

#include "common/recording/files.hpp"
#include "common/recording/writer.hpp"

namespace liloc::replay {

inline constexpr StampNs kSmallStart_ns = 1'700'000'000'000'000'000;

inline Camera small_camera() {
  Camera camera;
  camera.width = 80;
  camera.height = 60;
  camera.fx = camera.fy = 60;
  camera.cx = 39.5;
  camera.cy = 29.5;
  return camera;
}

/// A wall `millimetres` ahead.
inline DepthImage wall_image(StampNs stamp_ns, std::uint16_t millimetres) {
  return {stamp_ns, 80, 60, std::vector<std::uint16_t>(std::size_t{80} * 60, millimetres)};
}

/// One LiDAR `ceiling0`, one device `device0` with IMU and ground truth.
inline void write_small_recording(const std::filesystem::path& root) {
  Site site;
  site.global_lidars.push_back({"ceiling0", small_camera(), 10, Pose::Identity()});
  ASSERT_TRUE(write_site(root / "site.json", site));
  DeviceInfo info;
  info.id = "device0";
  info.camera = small_camera();
  info.rate_hz = 10;
  info.imu_rate_hz = 100;
  info.T_imu_sensor = Pose::Identity();
  const auto device = root / "devices/device0";
  ASSERT_TRUE(write_device(device / "device.json", info));
  std::vector<ImuSample> imu;
  std::vector<StampedPose> truth;
  for (int i = 0; i < 2; ++i) {
    const StampNs stamp_ns = kSmallStart_ns + i * from_ms(100);
    ASSERT_TRUE(write_depth(root / "global/ceiling0/depth", wall_image(stamp_ns, 2000)));
    ASSERT_TRUE(write_depth(device / "depth", wall_image(stamp_ns, 2000)));
    imu.push_back({stamp_ns, Eigen::Vector3d::Zero(), Eigen::Vector3d(0, 0, 9.81)});
    truth.push_back({stamp_ns, Pose::Identity()});
  }
  ASSERT_TRUE(write_imu(device / "imu.csv", imu));
  ASSERT_TRUE(write_tum(device / "groundtruth.tum", truth));
}

}  // namespace liloc::replay
