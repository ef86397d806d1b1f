#pragma once
// Which surfaces of the room a device's cloud shows at a pose, and how much each tells of where that is.
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "common/registration/target/target.hpp"

namespace liloc {

/// Surfaces of the room in cells of 0.25 m. Cells that many spots show count once, so that a device that stands
/// still learns nothing new.
class SurfaceBits {
 public:
  using Worth = std::unordered_map<std::uint64_t, float>;  ///< of each cell
  SurfaceBits() = default;
  /// As `worth` and `sum` told them.
  SurfaceBits(Worth worth, double sum) : worth_(std::move(worth)), sum_(sum) {}

  /// Adds what a device's thinned cloud, `medium` or `sparse` of its query, shows at a pose: of its points that
  /// lie on a surface that faces their way, the rarest one in each cell. A surface is worth the more the rarer
  /// such ones are at that height (`ScoreField`): 1 for the rarest, next to nothing for floor.
  void add(const Target& target, const Cloud& device_points, const Pose& T_map_sensor);

  /// Sum over the cells.
  [[nodiscard]] double sum() const { return sum_; }
  [[nodiscard]] std::size_t cells() const { return worth_.size(); }
  [[nodiscard]] const Worth& worth() const { return worth_; }

 private:
  Worth worth_;
  double sum_ = 0;
};

}  // namespace liloc
