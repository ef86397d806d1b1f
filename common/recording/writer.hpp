#pragma once
// The recording layout, written. Every call either succeeds whole or leaves nothing half-written behind.
#include "common/recording/recording.hpp"

namespace liloc {

[[nodiscard]] Status write_site(const std::filesystem::path& file, const Site& site);
[[nodiscard]] Status write_device(const std::filesystem::path& file, const DeviceInfo& device);
/// REC/.../depth/<stamp_ns>.png below `folder`.
[[nodiscard]] Status write_depth(const std::filesystem::path& folder, const DepthImage& image);
[[nodiscard]] Status write_imu(const std::filesystem::path& file, const std::vector<ImuSample>& samples);
/// TUM columns: t tx ty tz qx qy qz qw, seconds with 9 decimals.
[[nodiscard]] Status write_tum(const std::filesystem::path& file, const std::vector<StampedPose>& poses);

}  // namespace liloc
