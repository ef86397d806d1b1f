#include "common/registration/nearest_grid.hpp"

#include <algorithm>
#include <cmath>

namespace liloc {
namespace {

constexpr double kMostBlocks = 1 << 24;  // 67 MB of block table: a larger extent gets larger cells

}  // namespace

NearestGrid::NearestGrid(const std::vector<Eigen::Vector3f>& points, double cell_m, double reach_m) {
  Eigen::AlignedBox3f box;
  for (const auto& p : points)
    if (p.allFinite()) box.extend(p);
  if (box.isEmpty()) return;
  const Eigen::Vector3d size = (box.sizes().array() + 2 * static_cast<float>(reach_m)).cast<double>();
  const double blocks = size.prod() / std::pow(8 * cell_m, 3);
  const auto cell =
      static_cast<float>(blocks > kMostBlocks ? cell_m * std::cbrt(blocks / kMostBlocks) : cell_m);
  const float reach = std::max(static_cast<float>(reach_m), 0.9F * cell);  // a point owns at least its own cell
  inverse_ = 1.0F / cell;
  origin_ = box.min().array() - reach;
  const Eigen::Vector3i cells = ((box.sizes().array() + 2 * reach) * inverse_).ceil().cast<int>() + 1;
  extent_ = cells.cast<float>();
  block_count_ = (cells.array() + 7) / 8;
  blocks_.assign(static_cast<std::size_t>(block_count_.cast<std::int64_t>().prod()), kNone);
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].allFinite()) stamp(points, static_cast<std::int32_t>(i), cell, reach);
}

std::int32_t& NearestGrid::cell_at(const Eigen::Vector3i& cell) {
  std::int32_t& block = blocks_[block_index(cell)];
  if (block == kNone) {
    block = static_cast<std::int32_t>(cells_.size());
    cells_.emplace_back().fill(kNone);
  }
  return cells_[static_cast<std::size_t>(block)][cell_index(cell)];
}

void NearestGrid::stamp(const std::vector<Eigen::Vector3f>& points, std::int32_t index, float cell,
                        float reach) {
  const Eigen::Vector3f q = points[static_cast<std::size_t>(index)] - origin_;
  const Eigen::Vector3i lo = ((q.array() - reach) * inverse_).cast<int>().max(0);
  const Eigen::Vector3i hi = ((q.array() + reach) * inverse_).cast<int>().min(extent_.cast<int>().array() - 1);
  const float squared_reach = reach * reach;
  for (int z = lo.z(); z <= hi.z(); ++z) {
    const float dz = (static_cast<float>(z) + 0.5F) * cell - q.z();
    for (int y = lo.y(); y <= hi.y(); ++y) {
      const float dy = (static_cast<float>(y) + 0.5F) * cell - q.y(), dyz = dy * dy + dz * dz;
      if (dyz > squared_reach) continue;
      for (int x = lo.x(); x <= hi.x(); ++x) {
        const float dx = (static_cast<float>(x) + 0.5F) * cell - q.x(), squared = dx * dx + dyz;
        if (squared > squared_reach) continue;
        std::int32_t& held = cell_at({x, y, z});
        const Eigen::Vector3f centre = origin_ + Eigen::Vector3f(dx, dy, dz) + q;
        if (held == kNone || squared < (centre - points[static_cast<std::size_t>(held)]).squaredNorm())
          held = index;
      }
    }
  }
}

}  // namespace liloc
