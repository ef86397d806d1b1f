#include "common/registration/movers.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace liloc {
namespace {

constexpr double kCell_m = 0.08, kMostCells = 4e6;

}  // namespace

Movers::Movers(const Cloud& moving_map, double reach_m) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& p : moving_map.points)
    if (p.allFinite()) box.extend(p);
  if (box.isEmpty()) return;
  const auto reach = static_cast<float>(reach_m);
  origin_ = box.min().array() - reach;
  const Eigen::Vector3f size_m = box.sizes().array() + 2 * reach;
  const double cells = size_m.cast<double>().prod() / std::pow(kCell_m, 3);
  inverse_ = static_cast<float>(1.0 / (kCell_m * std::cbrt(std::max(1.0, cells / kMostCells))));
  size_ = (size_m * inverse_).array().ceil().cast<int>().max(1);
  extent_ = size_.cast<float>();
  cells_.assign(index({0, 0, size_.z()}), 0);
  for (const Eigen::Vector3f& p : moving_map.points)
    if (p.allFinite()) stamp((p - origin_).array(), reach);
}

void Movers::stamp(const Eigen::Array3f& q_m, float reach_m) {
  const Eigen::Array3i lo = ((q_m - reach_m) * inverse_).floor().cast<int>().max(0);
  const Eigen::Array3i hi = ((q_m + reach_m) * inverse_).cast<int>().min(size_.array() - 1);
  for (int z = lo.z(); z <= hi.z(); ++z)
    for (int y = lo.y(); y <= hi.y(); ++y)
      for (int x = lo.x(); x <= hi.x(); ++x) {
        const Eigen::Array3f centre = (Eigen::Array3f(x, y, z) + 0.5F) / inverse_;
        if ((centre - q_m).square().sum() <= reach_m * reach_m) cells_[index({x, y, z})] = 1;
      }
}

}  // namespace liloc
