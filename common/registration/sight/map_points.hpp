#pragma once
#include <array>
#include <vector>

#include "common/registration/points/vectors.hpp"
#include "common/registration/sight/sight.hpp"

namespace liloc {

enum class MapShare { all, half };
enum class MapOrder { together, as_given };  ///< as given: for points that are asked a few times only

/// The target's thinned points for the judge: every other one apart from the rest, and what lies together in
/// runs, so that those out of a device's view are passed over run by run.
class MapPoints {
 public:
  /// Of `stale` points only agreement counts: they may be hidden, or not there any more.
  explicit MapPoints(const std::vector<Eigen::Vector3f>& sound, const std::vector<Eigen::Vector3f>& stale = {},
                     MapOrder order = MapOrder::together);
  /// What a device's view says of them; T_sensor_map places them before the device.
  [[nodiscard]] SightView::Tally seen_by(const SightView& view, const Eigen::Isometry3f& T_sensor_map,
                                         float tolerance_m, MapShare share) const;

 private:
  /// Points in runs of kRun, each in a ball.
  struct Runs {
    Runs(std::vector<Eigen::Vector3f> points, MapOrder order);
    std::size_t count;
    Vectors points, centres;
    std::vector<float> radii;
  };
  static std::array<Runs, 2> every_other(const std::vector<Eigen::Vector3f>& points, MapOrder order);
  /// A device's view at a pose, with what bounds it.
  struct Placed {
    const SightView& view;
    const Eigen::Isometry3f& T_sensor_map;
    float tolerance_m;
    std::array<HalfSpace, 6> bounds;
  };
  static SightView::Tally tally(const Runs& runs, const Placed& placed);

  std::array<Runs, 2> sound_, stale_;
};

}  // namespace liloc
