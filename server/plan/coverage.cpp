#include "server/plan/coverage.hpp"

#include <numeric>

namespace liloc::plan {

Coverage::Coverage(const VoxelRoom& room, const DeviceViews& devices)
    : room_(room),
      devices_(devices),
      times_(room.surfaces(), 0),
      support_(devices.views.size()),
      chances_(devices.views.size(), 0),
      is_touched_(devices.views.size(), 0) {}

void Coverage::change(const std::vector<Surface>& seen, int sign) {
  touched_.clear();
  for (const Surface s : seen) {
    const bool was = times_[s] > 0;
    times_[s] = static_cast<std::uint8_t>(times_[s] + sign);
    if (was == (times_[s] > 0)) continue;
    const Eigen::Vector3f normal = room_.normal_map(s);
    for (std::uint32_t i = devices_.viewers_of[s]; i < devices_.viewers_of[s + 1]; ++i) {
      const std::uint32_t view = devices_.viewers[i];
      support_[view].add(normal, sign);
      if (is_touched_[view] == 0) touched_.push_back(view);
      is_touched_[view] = 1;
    }
  }
  for (const std::uint32_t view : touched_) {
    is_touched_[view] = 0;
    chances_[view] = chance_verified(features(view));
  }
}

double Coverage::covered_share() const {
  std::size_t covered = 0;
  for (Surface s = 0; s + 1 < room_.surfaces(); s += 2) covered += covers(s) || covers(s + 1) ? 1 : 0;
  return static_cast<double>(covered) / static_cast<double>(room_.voxels());
}

double Coverage::localizable_share() const {
  if (chances_.empty()) return 0;
  return std::accumulate(chances_.begin(), chances_.end(), 0.0) / static_cast<double>(chances_.size());
}

double Coverage::share_with(const std::vector<Surface>& seen) {
  add(seen);
  const double share = localizable_share();
  remove(seen);
  return share;
}

ViewFeatures Coverage::features(std::size_t view) const {
  return {static_cast<double>(devices_.views[view].seen.size()), support_[view], devices_.twins[view].alike};
}

}  // namespace liloc::plan
