#pragma once
// What a set of ceiling LiDARs sees of a room, and what that means for devices; LiDARs are added and taken
// away.
#include <vector>

#include "server/plan/prediction.hpp"

namespace liloc::plan {

/// Refers to a room and views, which must live on. One thread at a time.
class Coverage {
 public:
  Coverage(const VoxelRoom& room, const DeviceViews& devices);

  /// `seen`: what one LiDAR sees (SensorRays::seen).
  void add(const std::vector<Surface>& seen) { change(seen, 1); }
  /// What was added before.
  void remove(const std::vector<Surface>& seen) { change(seen, -1); }

  /// Share of the room's voxels that some LiDAR sees, from whichever side: the paper's overlap (section 3.1.4).
  [[nodiscard]] double covered_share() const;
  /// Mean over all device views of the chance that they are verified.
  [[nodiscard]] double localizable_share() const;
  /// What `localizable_share` would be with one LiDAR more. Changes nothing that can be seen.
  [[nodiscard]] double share_with(const std::vector<Surface>& seen);

  [[nodiscard]] ViewFeatures features(std::size_t view) const;
  [[nodiscard]] double chance(std::size_t view) const { return chances_[view]; }
  [[nodiscard]] bool covers(Surface surface) const { return times_[surface] > 0; }

 private:
  void change(const std::vector<Surface>& seen, int sign);

  const VoxelRoom& room_;
  const DeviceViews& devices_;
  std::vector<std::uint8_t> times_;     ///< per surface: LiDARs that see it
  std::vector<Support> support_;        ///< per view
  std::vector<double> chances_;         ///< per view
  std::vector<std::uint32_t> touched_;  ///< views, while they change
  std::vector<std::uint8_t> is_touched_;
};

}  // namespace liloc::plan
