#include "common/registration/field/score_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <numeric>

#include "common/registration/points/simd.hpp"

namespace liloc {
namespace {

constexpr float kUpright = 0.7F;      // |z| of a normal from which a surface counts as horizontal; 45 degrees
constexpr double kMostBits = 5.6;     // told by a rare surface: a fiftieth of its layer; by hand
constexpr double kLeastWeight = 0.1;  // of one that is everywhere; by hand
constexpr int kReadAhead = 31;        // rows are read in blocks of 32

/// What is near in a layer of a plane is worth by its rarity: a hit on what covers the share q of the space
/// that is known tells -log2(q) bits.
using Worths = std::array<std::int8_t, ScoreField::kSurface + 1>;
Worths worths_of(std::ptrdiff_t covered, std::ptrdiff_t known) {
  const double share = (static_cast<double>(covered) + 1) / (static_cast<double>(known) + 2);
  const double weight = std::clamp(-std::log2(share) / kMostBits, kLeastWeight, 1.0);
  Worths worths{};
  for (std::size_t near = 1; near < worths.size(); ++near)
    worths[near] = static_cast<std::int8_t>(std::lround(weight * static_cast<double>(near)));
  return worths;
}

/// A row of a field: `free` where it is open, else what is near.
void write_row(const std::int8_t* near, const std::int8_t* open, std::size_t width, std::int8_t free,
               const Worths& worths, std::int8_t* row) {
  for (std::size_t x = 0; x < width; ++x) row[x] = static_cast<std::int8_t>(open[x] & free);
  for (std::size_t x = 0; x < width; ++x) {
    std::uint64_t eight = 1;  // mostly nothing is near
    if (x % 8 == 0 && x + 8 <= width) std::memcpy(&eight, near + x, sizeof eight);
    if (eight == 0)
      x += 7;
    else if (near[x] != 0)
      row[x] = worths[static_cast<std::size_t>(near[x])];
  }
}

/// A grid of cells as a kernel sees it.
struct Lattice {
  float origin[3], extent[3], inverse;
  std::int32_t stride_y, stride_z, stride_plane, first, none;  ///< `none`: a cell that is always 0
};

LILOC_WIDE void cells_of(const Lattice& l, const float* x, const float* y, const float* z,
                         const std::int32_t* plane, const float* shift, std::size_t count,
                         std::int32_t* cells) {
  const float sx = shift[0], sy = shift[1], sz = shift[2];
#pragma omp simd
  for (std::size_t i = 0; i < count; ++i) {
    const float qx = (x[i] + sx - l.origin[0]) * l.inverse, qy = (y[i] + sy - l.origin[1]) * l.inverse,
                qz = (z[i] + sz - l.origin[2]) * l.inverse;
    const bool inside =
        (qx >= 0) & (qy >= 0) & (qz >= 0) & (qx < l.extent[0]) & (qy < l.extent[1]) & (qz < l.extent[2]);
    const std::int32_t cell = plane[i] * l.stride_plane + static_cast<std::int32_t>(qz) * l.stride_z +
                              static_cast<std::int32_t>(qy) * l.stride_y + static_cast<std::int32_t>(qx) +
                              l.first;
    cells[i] = inside ? cell : l.none;
  }
}

}  // namespace

int ScoreField::plane_of(const Eigen::Vector3f& normal_map) {
  if (normal_map.z() > kUpright) return kUp;
  if (normal_map.z() < -kUpright) return kDown;
  constexpr float kTan = 0.41421356F;  // of half an octant
  const float x = normal_map.x(), y = normal_map.y(), along_x = std::abs(x), along_y = std::abs(y);
  if (along_y <= kTan * along_x) return x >= 0 ? 0 : 4;
  if (along_x <= kTan * along_y) return y > 0 ? 2 : 6;
  if (y > 0) return x > 0 ? 1 : 3;
  return x > 0 ? 7 : 5;
}

ScoreField::ScoreField(const FieldLayers& layers, const FieldOptions& options) : pad_(options.pad) {
  if (layers.empty()) return;
  cell_ = layers.cell_m();
  inverse_ = static_cast<float>(1.0 / cell_);
  origin_ = layers.origin();
  size_ = layers.size();
  extent_ = size_.cast<float>();
  stride_ = size_.x() + 2 * pad_;
  cells_.assign(index(0, 0, 0, kAny + 1) + kReadAhead, 0);
  for (int z = 0; z < size_.z(); ++z) take_layer(layers, z, options.free);
}

void ScoreField::take_layer(const FieldLayers& layers, int z, int free) {
  const auto width = static_cast<std::size_t>(size_.x()), rows = static_cast<std::size_t>(size_.y());
  const std::int8_t* any = layers.near(0, z, kAny);
  const std::uint8_t* through = layers.through(0, z);
  std::vector<std::int8_t> open(width * rows);  // -1: the ceiling looked through, and nothing is near
  for (std::size_t i = 0; i < open.size(); ++i)
    open[i] = static_cast<std::int8_t>(-static_cast<int>((any[i] == 0) & (through[i] != 0)));
  const auto nothing = std::count(any, any + open.size(), std::int8_t{0}) +
                       std::accumulate(open.begin(), open.end(), std::ptrdiff_t{0});
  const std::ptrdiff_t known = static_cast<std::ptrdiff_t>(open.size()) - nothing;
  for (int plane = 0; plane <= kAny; ++plane) {
    const std::int8_t* near = layers.near(0, z, plane);
    const auto covered =
        std::count_if(near, near + open.size(), [](std::int8_t v) { return v > kSurface / 2; });
    Worths worths = worths_of(covered, known);
    if (plane == kAny) std::iota(worths.begin(), worths.end(), std::int8_t{0});
    for (int y = 0; y < size_.y(); ++y)
      write_row(layers.near(y, z, plane), open.data() + static_cast<std::size_t>(y) * width, width,
                static_cast<std::int8_t>(plane == kAny ? -kSurface : free), worths,
                cells_.data() + index(0, y, z, plane));
  }
}

void ScoreField::look_up(const Probes& probes, const Eigen::Vector3f& shift,
                         std::span<std::int32_t> worths) const {
  const std::int32_t layer = stride_ * size_.y();
  const Lattice lattice{{origin_.x(), origin_.y(), origin_.z()},
                        {extent_.x(), extent_.y(), extent_.z()},
                        inverse_,
                        stride_,
                        layer,
                        layer * size_.z(),
                        pad_,
                        static_cast<std::int32_t>(cells_.size()) - 1};  // read ahead alone
  cells_of(lattice, probes.x.data(), probes.y.data(), probes.z.data(), probes.plane.data(), shift.data(),
           worths.size(), worths.data());
  for (std::int32_t& worth : worths) worth = cells_[static_cast<std::size_t>(worth)];
}

void ScoreField::forget_free_space(const VoxelMask& dynamic_mask) {
  dynamic_mask.for_each_place([&](const Eigen::Vector3f& p_map) {
    const Eigen::Array3f q = ((p_map - origin_) * inverse_).array();
    if (!((q >= 0).all() && (q < extent_.array()).all())) return;
    const Eigen::Array3i cell = q.cast<int>();
    for (int plane = 0; plane <= kAny; ++plane) {
      std::int8_t& held = cells_[index(cell.x(), cell.y(), cell.z(), plane)];
      held = std::max<std::int8_t>(held, 0);
    }
  });
}

}  // namespace liloc
