#pragma once
// A sequence of the TUM RGB-D benchmark (cvg.cit.tum.de/data/datasets/rgbd-dataset/file_formats): depth.txt
// names PNG files of 5000 units a metre with their stamps, groundtruth.txt holds the poses of the camera. A
// sequence is one device; it has no ceiling LiDARs.
#include <filesystem>
#include <functional>

#include "common/recording/convert_error.hpp"
#include "common/recording/recording.hpp"

namespace liloc {

constexpr double kTumDepthScale_m = 1.0 / 5000;

[[nodiscard]] bool is_tum_folder(const std::filesystem::path& folder);

/// Writes the sequence as `devices/<device.id>` of the recording at `out`, groundtruth.tum only where the
/// sequence has groundtruth.txt. The camera's scale and the rate are the sequence's. Returns the number of
/// frames. Errors name file and line: a row that is none, an image elsewhere than in the folder, of another
/// size, damaged; no frame;
/// `stopped`, asked at each frame, said so.
[[nodiscard]] Conversion<std::size_t> tum_to_device(const std::filesystem::path& tum,
                                                    const std::filesystem::path& out, DeviceInfo device,
                                                    const std::function<bool()>& stopped = {});

/// The reverse, to the folder `out`; what is farther than 13.1 m does not fit and is left out.
[[nodiscard]] Conversion<void> device_to_tum(const DeviceRecording& device, const std::filesystem::path& out,
                                             const std::function<bool()>& stopped = {});

}  // namespace liloc
