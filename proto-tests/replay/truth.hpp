#pragma once
// The truth of a recording, as the judge of `liloc replay` sees it: device poses, and how much of a device
// frame the ceiling sees. Definitions are fixed (0.05 m voxels, 0.075 m, 6 m); they do not follow the replay's
// options.
#include <vector>

#include "common/recording/recording.hpp"

namespace liloc::replay {

/// The poses of a device's frames. `pose(i)` is that of frame i.
class Truth {
 public:
  /// Empty when the recording has no ground truth. Errors: it cannot be read, or does not fit the frames.
  [[nodiscard]] static Result<Truth> of(const DeviceRecording& device);

  [[nodiscard]] bool empty() const { return poses_.empty(); }
  [[nodiscard]] std::size_t size() const { return poses_.size(); }
  [[nodiscard]] const Pose& pose(std::size_t frame) const { return poses_[frame]; }
  /// The frame whose stamp is nearest and within 5 ms, or -1.
  [[nodiscard]] std::ptrdiff_t frame_near(StampNs stamp_ns) const;
  /// Length of the path through all poses, metres.
  [[nodiscard]] double path_m() const;

 private:
  std::vector<StampNs> stamps_;
  std::vector<Pose> poses_;
};

/// A depth frame and where it was taken from.
struct PlacedFrame {
  const DepthImage& image;
  const Camera& camera;
  Pose T_map_sensor;
};

/// Share of the device's points within 6 m (0.05 m voxels) that lie within 0.075 m of the ceiling clouds of
/// that moment, with the device at its true pose; 0 without ceiling frames within 100 ms, or with no points.
[[nodiscard]] double overlap_at_truth(const std::vector<PlacedFrame>& ceiling, const PlacedFrame& device);
/// The same from files.
[[nodiscard]] double overlap_at_truth(const Recording& recording, const DeviceRecording& device,
                                      const DepthFile& frame, const Pose& T_map_sensor);

}  // namespace liloc::replay
