#include "common/registration/points/nearest_grid.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/registration/points/simd.hpp"
#include "common/registration/points/voxel_mask.hpp"

namespace liloc {
namespace {

constexpr double kMostBlocks = 1 << 24;  // 67 MB of block table: a larger extent gets larger cells; by hand
constexpr std::size_t kAtOnce = 256;     // points whose cells are found before any is looked up
constexpr float kSnapCells = 8;          // so that a point at the rim that moves a little moves no cell
/// While a grid is taken over: a cell whose point is gone; below, who has it for now.
constexpr std::int32_t kLeft = NearestGrid::kNone - 1;

/// The cells of a grid as a kernel sees them. `outside`: the block of what lies outside.
struct Shape {
  float origin[3], extent[3], shift[3], inverse;
  std::uint32_t blocks_x, blocks_y, outside;
};

LILOC_WIDE void find_cells(const Shape& shape, const PointRun& points, std::uint32_t* blocks,
                           std::uint32_t* cells) {
  const Shape g = shape;
  const float *x = points.x, *y = points.y, *z = points.z;
  const std::size_t count = points.count;
#pragma omp simd
  for (std::size_t i = 0; i < count; ++i) {
    const float qx = (x[i] + g.shift[0] - g.origin[0]) * g.inverse,
                qy = (y[i] + g.shift[1] - g.origin[1]) * g.inverse,
                qz = (z[i] + g.shift[2] - g.origin[2]) * g.inverse;
    const bool inside =
        (qx >= 0) & (qy >= 0) & (qz >= 0) & (qx < g.extent[0]) & (qy < g.extent[1]) & (qz < g.extent[2]);
    const auto cx = static_cast<std::uint32_t>(static_cast<std::int32_t>(qx)),
               cy = static_cast<std::uint32_t>(static_cast<std::int32_t>(qy)),
               cz = static_cast<std::uint32_t>(static_cast<std::int32_t>(qz));
    const std::uint32_t block = ((cz >> 3) * g.blocks_y + (cy >> 3)) * g.blocks_x + (cx >> 3);
    blocks[i] = inside ? block : g.outside;
    cells[i] = (cz & 7) << 6 | (cy & 7) << 3 | (cx & 7);
  }
}

}  // namespace

NearestGrid::NearestGrid(const std::vector<Eigen::Vector3f>& points, double cell_m, double reach_m) {
  make(points, cell_m, reach_m, {});
}

NearestGrid::NearestGrid(const std::vector<Eigen::Vector3f>& points, double cell_m, double reach_m,
                         const NearestGrid& before, const CloudChange& change) {
  make(points, cell_m, reach_m, {&before, &change});
}

void NearestGrid::make(const std::vector<Eigen::Vector3f>& points, double cell_m, double reach_m,
                       const Earlier& earlier) {
  const std::vector<Region> regions = regions_of(points, std::max(kFarApart_m, 4 * reach_m));
  const bool same_regions = earlier.grid != nullptr && earlier.grid->beyond_.size() + 1 == regions.size();
  for (std::size_t k = 0; k < regions.size(); ++k) {
    NearestGrid& grid = k == 0 ? *this : beyond_.emplace_back();
    const NearestGrid* before = same_regions ? k == 0 ? earlier.grid : &earlier.grid->beyond_[k - 1] : nullptr;
    grid.make_region(points, regions[k], cell_m, reach_m, {before, earlier.change});
  }
}

void NearestGrid::make_region(const std::vector<Eigen::Vector3f>& points, const Region& region, double cell_m,
                              double reach_m, const Earlier& earlier) {
  lay_out(points, region, cell_m, reach_m);
  const NearestGrid* before = earlier.grid;
  const bool same_cells = before != nullptr && !blocks_.empty() && origin_ == before->origin_ &&
                          extent_ == before->extent_ && cell_ == before->cell_ && reach_ == before->reach_;
  if (!same_cells || !earlier.change->little(points.size())) {
    for (std::size_t i = 0; i < points.size(); ++i)
      if (holds(region, points[i])) stamp(points, i);
    return;
  }
  take_over(*before, earlier.change->now);
  const VoxelMask touched = VoxelMask::covering(earlier.change->gone, 2 * static_cast<double>(reach_));
  for (std::size_t i = 0; i < points.size(); ++i)
    if (holds(region, points[i]) && touched.at(points[i])) fill_left(points, i);
  for (Block& block : cells_)
    for (std::int32_t& held : block)
      if (held <= kLeft) held = held == kLeft ? kNone : kLeft - 1 - held;
  for (const std::uint32_t i : earlier.change->fresh)
    if (holds(region, points[i])) stamp(points, i);
}

void NearestGrid::lay_out(const std::vector<Eigen::Vector3f>& points, const Region& region, double cell_m,
                          double reach_m) {
  Eigen::AlignedBox3f box;
  for (const auto& p : points)
    if (holds(region, p)) box.extend(p);
  if (box.isEmpty()) return;
  const Eigen::Vector3d size = (box.sizes().array() + 2 * static_cast<float>(reach_m)).cast<double>();
  const double blocks = size.prod() / std::pow(8 * cell_m, 3);
  cell_ = static_cast<float>(blocks > kMostBlocks ? cell_m * std::cbrt(blocks / kMostBlocks) : cell_m);
  reach_ = std::max(static_cast<float>(reach_m), 0.9F * cell_);  // a point owns at least its own cell
  inverse_ = 1.0F / cell_;
  const float snap = kSnapCells * cell_;
  origin_ = ((box.min().array() - reach_) / snap).floor() * snap;
  const Eigen::Array3f end = ((box.max().array() + reach_) / snap).ceil() * snap;
  const Eigen::Vector3i cells = ((end - origin_.array()) * inverse_).round().cast<int>() + 1;
  extent_ = cells.cast<float>();
  block_count_ = (cells.array() + 7) / 8;
  blocks_.assign(static_cast<std::size_t>(block_count_.cast<std::int64_t>().prod()) + 1, kNone);
}

std::int32_t NearestGrid::nearest_beyond(const Eigen::Vector3f& p) const {
  for (const NearestGrid& grid : beyond_)
    if (const std::int32_t found = grid.nearest(p); found != kNone) return found;
  return kNone;
}

void NearestGrid::nearest(const PointRun& points, const Eigen::Vector3f& shift, std::int32_t* indices) const {
  if (blocks_.empty()) {
    std::fill_n(indices, points.count, kNone);
    return;
  }
  const Shape shape{{origin_.x(), origin_.y(), origin_.z()},
                    {extent_.x(), extent_.y(), extent_.z()},
                    {shift.x(), shift.y(), shift.z()},
                    inverse_,
                    static_cast<std::uint32_t>(block_count_.x()),
                    static_cast<std::uint32_t>(block_count_.y()),
                    static_cast<std::uint32_t>(blocks_.size()) - 1};
  std::array<std::uint32_t, kAtOnce> blocks, cells;
  for (std::size_t begin = 0; begin < points.count; begin += kAtOnce) {
    const std::size_t here = std::min(kAtOnce, points.count - begin);
    find_cells(shape, {points.x + begin, points.y + begin, points.z + begin, here}, blocks.data(),
               cells.data());
    for (std::size_t i = 0; i < here; ++i) {
      const std::int32_t block = blocks_[blocks[i]];
      indices[begin + i] = block == kNone ? kNone : cells_[static_cast<std::size_t>(block)][cells[i]];
    }
  }
  if (beyond_.empty()) return;
  for (std::size_t i = 0; i < points.count; ++i)
    if (indices[i] == kNone)
      indices[i] = nearest_beyond(Eigen::Vector3f(points.x[i], points.y[i], points.z[i]) + shift);
}

/// What the grid before held, by the indices of now; what is gone leaves its cells to others. Blocks that held
/// nothing are left out.
void NearestGrid::take_over(const NearestGrid& before, const std::vector<std::int32_t>& now) {
  cells_.reserve(before.cells_.size());
  for (std::size_t at = 0; at < blocks_.size(); ++at) {
    if (before.blocks_[at] == kNone) continue;
    Block& block = cells_.emplace_back();
    bool any = false;
    const Block& was = before.cells_[static_cast<std::size_t>(before.blocks_[at])];
    for (std::size_t i = 0; i < block.size(); ++i) {
      block[i] = was[i] == kNone ? kNone : now[static_cast<std::size_t>(was[i])];
      if (was[i] != kNone && block[i] == CloudChange::kGone) block[i] = kLeft;
      any |= block[i] != kNone;
    }
    if (any)
      blocks_[at] = static_cast<std::int32_t>(cells_.size()) - 1;
    else
      cells_.pop_back();
  }
}

std::int32_t& NearestGrid::cell_at(const Eigen::Vector3i& cell) {
  std::int32_t& block = blocks_[block_index(cell)];
  if (block == kNone) {
    block = static_cast<std::int32_t>(cells_.size());
    cells_.emplace_back().fill(kNone);
  }
  return cells_[static_cast<std::size_t>(block)][cell_index(cell)];
}

/// Calls visit(cell, squared distance of its centre) for each cell in reach of a point.
template <class Visit>
void NearestGrid::for_each_in_reach(const Eigen::Vector3f& point, const Visit& visit) const {
  if (!point.allFinite()) return;
  const Eigen::Vector3f q = point - origin_;
  const Eigen::Vector3i lo = ((q.array() - reach_) * inverse_).cast<int>().max(0);
  const Eigen::Vector3i hi = ((q.array() + reach_) * inverse_).cast<int>().min(extent_.cast<int>().array() - 1);
  const float squared_reach = reach_ * reach_;
  const auto off = [&](int at, float of) { return (static_cast<float>(at) + 0.5F) * cell_ - of; };
  for (int z = lo.z(); z <= hi.z(); ++z)
    for (int y = lo.y(); y <= hi.y(); ++y) {
      const float dy = off(y, q.y()), dz = off(z, q.z()), squared_yz = dy * dy + dz * dz;
      if (squared_yz > squared_reach) continue;
      for (int x = lo.x(); x <= hi.x(); ++x) {
        const float dx = off(x, q.x()), squared = dx * dx + squared_yz;
        if (squared <= squared_reach) visit(Eigen::Vector3i(x, y, z), squared);
      }
    }
}

float NearestGrid::squared_distance(const Eigen::Vector3i& cell, const Eigen::Vector3f& point) const {
  const Eigen::Vector3f q = point - origin_;
  const auto off = [&](int axis) { return (static_cast<float>(cell[axis]) + 0.5F) * cell_ - q[axis]; };
  const float dx = off(0), dy = off(1), dz = off(2), squared_yz = dy * dy + dz * dz;
  return dx * dx + squared_yz;
}

/// Takes the cells in reach of a point that have none nearer; of two as near the first. Whatever the order of
/// points, and however often one comes, the cells end up the same.
void NearestGrid::stamp(const std::vector<Eigen::Vector3f>& points, std::size_t index) {
  const auto own = static_cast<std::int32_t>(index);
  for_each_in_reach(points[index], [&](const Eigen::Vector3i& cell, float squared) {
    std::int32_t& held = cell_at(cell);
    if (held != kNone) {
      const float other = squared_distance(cell, points[static_cast<std::size_t>(held)]);
      if (squared > other || (squared == other && held < own)) return;
    }
    held = own;
  });
}

/// The same, of cells that were taken from what is gone alone.
void NearestGrid::fill_left(const std::vector<Eigen::Vector3f>& points, std::size_t index) {
  const auto own = static_cast<std::int32_t>(index);
  for_each_in_reach(points[index], [&](const Eigen::Vector3i& cell, float squared) {
    const std::int32_t block = blocks_[block_index(cell)];
    if (block == kNone) return;
    std::int32_t& held = cells_[static_cast<std::size_t>(block)][cell_index(cell)];
    if (held > kLeft) return;
    if (held != kLeft) {
      const std::int32_t holder = kLeft - 1 - held;
      const float other = squared_distance(cell, points[static_cast<std::size_t>(holder)]);
      if (squared > other || (squared == other && holder < own)) return;
    }
    held = kLeft - 1 - own;
  });
}

}  // namespace liloc
