#pragma once
// The recording layout, read: site.json, ceiling and device depth, IMU, ground truth (evaluation alone).
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/camera.hpp"

namespace liloc {

struct DeviceInfo {
  std::string id;
  Camera camera;
  double rate_hz = 0;
  double still_seconds = 0;  ///< the device stands still for so long at the start
  std::optional<double> imu_rate_hz;
  std::optional<Pose> T_imu_sensor;
};

/// A depth image on disk; read when it is needed.
struct DepthFile {
  StampNs stamp_ns = 0;
  std::filesystem::path path;
};

struct StampedPose {
  StampNs stamp_ns = 0;
  Pose T_map_sensor = Pose::Identity();
};

struct DeviceRecording {
  DeviceInfo info;
  std::filesystem::path folder;
  std::vector<DepthFile> depth;  ///< by rising stamp
  std::vector<ImuSample> imu;    ///< by rising stamp; empty without imu.csv
};

struct LidarRecording {
  GlobalLidar info;
  std::vector<DepthFile> depth;  ///< by rising stamp
};

struct Recording {
  std::filesystem::path root;
  Site site;
  std::vector<LidarRecording> lidars;    ///< in the order of site.global_lidars
  std::vector<DeviceRecording> devices;  ///< by id; empty where the recording has none
};

/// Errors name file, field, value and remedy; nothing is half-read. Frames are listed, not decoded.
[[nodiscard]] Result<Recording> open_recording(const std::filesystem::path& root);
[[nodiscard]] Result<Site> read_site(const std::filesystem::path& file);
[[nodiscard]] Result<DeviceInfo> read_device(const std::filesystem::path& file);
[[nodiscard]] Result<std::vector<ImuSample>> read_imu(const std::filesystem::path& file);

/// Ground truth of a device: for evaluation only. An absent file is an empty list.
[[nodiscard]] Result<std::vector<StampedPose>> read_ground_truth(const DeviceRecording& device);
[[nodiscard]] Result<std::vector<StampedPose>> read_tum(const std::filesystem::path& file);

/// 16-bit greyscale PNG of the camera's size; the stamp is the caller's, every missing return is 0.
[[nodiscard]] Result<DepthImage> read_depth(const DepthFile& file, const Camera& camera);

}  // namespace liloc
