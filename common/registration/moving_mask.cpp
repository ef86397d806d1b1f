#include "common/registration/moving_mask.hpp"

#include <cmath>

namespace liloc {

MovingMask::MovingMask(const ScoreField& field, const Cloud& moving_map, double reach_m) : field_(field) {
  if (moving_map.empty() || field.empty()) return;
  const Eigen::Vector3i size = field.size();
  cells_.assign(index(0, 0, size.z()), 0);
  const auto cell_m = static_cast<float>(field.cell_m());
  const int reach = static_cast<int>(std::ceil(reach_m / field.cell_m()));
  for (const Eigen::Vector3f& p : moving_map.points) {
    const Eigen::Array3i cell = ((p - field.origin()) / cell_m).array().floor().cast<int>();
    const Eigen::Array3i lo = (cell - reach).max(0), hi = (cell + reach).min(size.array() - 1);
    for (int z = lo.z(); z <= hi.z(); ++z)
      for (int y = lo.y(); y <= hi.y(); ++y)
        for (int x = lo.x(); x <= hi.x(); ++x) cells_[index(x, y, z)] = 1;
  }
}

bool MovingMask::at(const Eigen::Vector3f& p_map) const {
  if (cells_.empty()) return false;
  const Eigen::Array3f q = ((p_map - field_.origin()) / static_cast<float>(field_.cell_m())).array();
  if (!((q >= 0).all() && (q < field_.size().cast<float>().array()).all())) return false;
  const Eigen::Array3i cell = q.cast<int>();
  return cells_[index(cell.x(), cell.y(), cell.z())] != 0;
}

ScoreField MovingMask::applied() const {
  ScoreField field = field_;
  if (!cells_.empty()) field.forget_free_space(cells_);
  return field;
}

}  // namespace liloc
