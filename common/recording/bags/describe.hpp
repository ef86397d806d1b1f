#pragma once
// Private to the room: the sensors of a recording, from what a bag says of them and what the options say.
#include <vector>

#include "common/recording/bags/convert.hpp"
#include "common/recording/bags/survey.hpp"
#include "common/recording/recording.hpp"

namespace liloc::bags {

struct Description {
  Site site;                        ///< the LiDARs that were asked for, by id
  std::vector<DeviceInfo> devices;  ///< by id
};

/// The topics that the options name.
[[nodiscard]] std::vector<std::string> topics_of(const ConvertOptions& options);

/// Before anything is read. Errors: an id that is none, a topic for two sensors, an IMU or a file for a device
/// that is not asked for, no LiDAR.
[[nodiscard]] Status check(const ConvertOptions& options);

/// Errors: a topic that is absent or of another type, intrinsics or extrinsics that neither the bag nor a file
/// tells.
[[nodiscard]] Result<Description> describe(const std::filesystem::path& bag, const Survey& survey,
                                           const ConvertOptions& options);

}  // namespace liloc::bags
