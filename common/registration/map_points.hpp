#pragma once
#include <vector>

#include "common/registration/sight.hpp"
#include "common/registration/vectors.hpp"

namespace liloc {

enum class MapShare { all, half };

/// The target's thinned points in the order in which the judge asks for them: every other one first.
class MapPoints {
 public:
  /// Of `stale` points only agreement counts: they may be hidden, or not there any more.
  explicit MapPoints(const std::vector<Eigen::Vector3f>& sound, const std::vector<Eigen::Vector3f>& stale = {});

  /// What a device's view says of them; T_sensor_map places them before the device.
  [[nodiscard]] SightView::Tally seen_by(const SightView& view, const Eigen::Isometry3f& T_sensor_map,
                                         float tolerance_m, MapShare share) const;

 private:
  Vectors sound_, stale_;
  std::size_t sound_count_, stale_count_;
};

}  // namespace liloc
