#pragma once
#include "common/registration/score_field.hpp"

namespace liloc {

/// Places near what moves right now. A field is made of the still room and calls them empty, yet a device may
/// see somebody there. The field outlives the mask.
class MovingMask {
 public:
  MovingMask(const ScoreField& field, const Cloud& moving_map, double reach_m);

  [[nodiscard]] bool empty() const { return cells_.empty(); }
  [[nodiscard]] bool at(const Eigen::Vector3f& p_map) const;
  /// A copy of the field to which these places are unknown.
  [[nodiscard]] ScoreField applied() const;

 private:
  [[nodiscard]] std::size_t index(int x, int y, int z) const {
    const auto size = field_.size().cast<std::size_t>();
    return (static_cast<std::size_t>(z) * size.y() + static_cast<std::size_t>(y)) * size.x() +
           static_cast<std::size_t>(x);
  }

  const ScoreField& field_;
  std::vector<std::uint8_t> cells_;
};

}  // namespace liloc
