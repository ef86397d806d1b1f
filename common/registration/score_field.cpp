#include "common/registration/score_field.hpp"

#include <algorithm>
#include <cmath>

namespace liloc {
namespace {

constexpr double kMostCells = 64e6;

}  // namespace

ScoreField::ScoreField(const Cloud& cloud_map, const std::vector<SightView>& views, double cell_m,
                       double surface_sd_m) {
  Eigen::AlignedBox3f box;
  for (const auto& p : cloud_map.points)
    if (p.allFinite()) box.extend(p);
  if (box.isEmpty()) return;
  const Eigen::Vector3d size_m = (box.sizes().array() + 4 * static_cast<float>(cell_m)).cast<double>();
  const double cells = size_m.prod() / std::pow(cell_m, 3);
  cell_ = cells > kMostCells ? cell_m * std::cbrt(cells / kMostCells) : cell_m;
  inverse_ = static_cast<float>(1.0 / cell_);
  origin_ = box.min().array() - 2 * static_cast<float>(cell_);
  size_ = (size_m.cast<float>() * inverse_).array().ceil().cast<int>();
  extent_ = size_.cast<float>();
  cells_.assign(static_cast<std::size_t>(size_.cast<std::int64_t>().prod()), 0);
  add_surfaces(cloud_map, surface_sd_m);
  mark_free_space(views);
}

void ScoreField::add_surfaces(const Cloud& cloud_map, double surface_sd_m) {
  const auto cell = static_cast<float>(cell_);
  const auto reach = static_cast<float>(2.2 * surface_sd_m);
  const auto exponent = static_cast<float>(-0.5 / (surface_sd_m * surface_sd_m));
  for (const Eigen::Vector3f& p : cloud_map.points) {
    if (!p.allFinite()) continue;
    const Eigen::Array3f q = (p - origin_).array();
    const Eigen::Vector3i lo = ((q - reach) * inverse_).floor().cast<int>().max(0);
    const Eigen::Vector3i hi = ((q + reach) * inverse_).cast<int>().min(size_.array() - 1);
    for (int z = lo.z(); z <= hi.z(); ++z)
      for (int y = lo.y(); y <= hi.y(); ++y)
        for (int x = lo.x(); x <= hi.x(); ++x) {
          const Eigen::Array3f centre = (Eigen::Array3f(x, y, z) + 0.5F) * cell;
          const float squared = (centre - q).square().sum();
          if (squared > reach * reach) continue;
          const auto value = static_cast<std::int8_t>(kSurface * std::exp(exponent * squared));
          std::int8_t& held = cells_[index(x, y, z)];
          held = std::max(held, value);
        }
  }
}

void ScoreField::mark_free_space(const std::vector<SightView>& views) {
  const auto tolerance = static_cast<float>(0.5 * cell_ + 0.03);
  for (int z = 0; z < size_.z(); ++z)
    for (int y = 0; y < size_.y(); ++y)
      for (int x = 0; x < size_.x(); ++x) {
        std::int8_t& held = cells_[index(x, y, z)];
        if (held != 0) continue;
        const Eigen::Vector3f centre =
            origin_ + (Eigen::Vector3f(x, y, z).array() + 0.5F).matrix() * static_cast<float>(cell_);
        for (const SightView& view : views)
          if (view.look(centre, tolerance) == Sight::conflict) {
            held = kFree;
            break;
          }
      }
}

}  // namespace liloc
