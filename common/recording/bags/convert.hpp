#pragma once
// A ROS 2 bag as a recording of the layout.
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "common/recording/convert_error.hpp"

namespace liloc::bags {

/// Which topic is whose; ids as in the layout.
struct ConvertOptions {
  std::map<std::string, std::string> lidars;            ///< ceiling LiDAR -> topic of its Image or PointCloud2
  std::map<std::string, std::string> devices;           ///< device -> topic of its depth Image
  std::map<std::string, std::string> imus;              ///< device -> topic of its Imu
  std::map<std::string, std::filesystem::path> truths;  ///< device -> TUM file of T_map_sensor
  /// Device -> device.json with intrinsics, depth scale, T_imu_sensor; else from CameraInfo and transforms.
  std::map<std::string, std::filesystem::path> device_files;
  /// The LiDARs' intrinsics, depth scale and extrinsics; empty: from their CameraInfo and the bag's transforms.
  std::filesystem::path site_file;
  std::string world_frame = "map";
  std::optional<double> still_seconds;  ///< at the start; empty: as the device's file says, else 0
  std::function<bool()> stopped = {};   ///< asked at each message; true ends it as an error
};

/// Messages that could not be used: of another kind or size than they should be, damaged.
struct LeftOut {
  std::size_t messages = 0;
  std::string first;  ///< why the first could not, without the topic's name
  void add(const Error& error) {
    if (messages++ == 0) first = error.message;
  }
};
using LeftOutByTopic = std::map<std::string, LeftOut, std::less<>>;

struct Converted {
  std::map<std::string, std::size_t> messages;  ///< frames and samples per topic that was asked for
  LeftOutByTopic left_out;
};

/// Reads the bag twice: first what describes it, then the frames. `out` must be absent or an empty folder; when
/// anything is wrong it is left as it was. Intrinsics of a topic x/image come from x/camera_info. Messages
/// that cannot be used are left out and counted. Errors: one line that names file, topic and remedy; also a
/// topic of which no message can be used.
[[nodiscard]] Conversion<Converted> convert_bag(const std::filesystem::path& bag,
                                                const std::filesystem::path& out,
                                                const ConvertOptions& options);

}  // namespace liloc::bags
