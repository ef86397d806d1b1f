#pragma once
#include <cstdint>
#include <vector>

#include "common/geometry/cloud.hpp"
#include "common/registration/sight.hpp"

namespace liloc {

/// What a device point is worth at each place of the room: up to +100 on a measured surface, kFree where the
/// ceiling looked through empty space, 0 where nobody looked. A pose scores by one look-up per device point,
/// free space included. x runs fastest; `at` outside the field is 0.
class ScoreField {
 public:
  static constexpr int kSurface = 100, kFree = -100;

  ScoreField() = default;
  /// `cloud` in the map frame, at most `cell_m` apart on surfaces.
  ScoreField(const Cloud& cloud_map, const std::vector<SightView>& views, double cell_m, double surface_sd_m);

  [[nodiscard]] int at(const Eigen::Vector3f& p_map) const {
    const Eigen::Vector3f q = (p_map - origin_) * inverse_;
    if (!((q.array() >= 0).all() && (q.array() < extent_.array()).all())) return 0;
    return cells_[index(static_cast<int>(q.x()), static_cast<int>(q.y()), static_cast<int>(q.z()))];
  }

  [[nodiscard]] bool empty() const { return cells_.empty(); }
  [[nodiscard]] double cell_m() const { return cell_; }
  [[nodiscard]] const Eigen::Vector3f& origin() const { return origin_; }  ///< corner of cell (0,0,0)
  [[nodiscard]] const Eigen::Vector3i& size() const { return size_; }      ///< cells
  [[nodiscard]] const std::int8_t* row(int y, int z) const { return cells_.data() + index(0, y, z); }

 private:
  [[nodiscard]] std::size_t index(int x, int y, int z) const {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(size_.y()) + static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(size_.x()) +
           static_cast<std::size_t>(x);
  }
  void add_surfaces(const Cloud& cloud_map, double surface_sd_m);
  void mark_free_space(const std::vector<SightView>& views);

  double cell_ = 0;
  float inverse_ = 1;
  Eigen::Vector3f origin_ = Eigen::Vector3f::Zero(), extent_ = Eigen::Vector3f::Zero();
  Eigen::Vector3i size_ = Eigen::Vector3i::Zero();
  std::vector<std::int8_t> cells_;
};

}  // namespace liloc
