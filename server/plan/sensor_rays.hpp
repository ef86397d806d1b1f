#pragma once
// A depth sensor as rays: which surfaces of a room it sees from a place.
#include <vector>

#include "common/geometry/camera.hpp"
#include "server/plan/voxel_room.hpp"

namespace liloc::plan {

/// Along the ray, of a ceiling LiDAR: as far as the server takes its returns (DepthOptions).
constexpr double kLidarRange_m = 8.5;

/// A sensor's view at so few rays that they are a voxel apart at its range. Immutable.
class SensorRays {
 public:
  /// `camera` is a validated one; `range_m` along the ray, 0.5 to 30 m.
  SensorRays(const Camera& camera, double range_m);

  /// Surfaces that give a return: rising, each once, with no room to spare. Those met under less than 6
  /// degrees give none.
  [[nodiscard]] std::vector<Surface> seen(const VoxelRoom& room, const Pose& T_map_sensor) const;

  /// Ranges at a coarse grid of the view, `kGridColumns` x `kGridRows`, row by row, in metres; the range limit
  /// where nothing is met.
  static constexpr int kGridColumns = 16, kGridRows = 12;
  [[nodiscard]] std::vector<float> ranges(const VoxelRoom& room, const Pose& T_map_sensor) const;

  [[nodiscard]] double range_m() const { return range_m_; }
  [[nodiscard]] std::size_t size() const { return directions_.size(); }

 private:
  std::vector<Eigen::Vector3f> directions_, grid_;  ///< unit, sensor frame
  float range_m_;
};

}  // namespace liloc::plan
