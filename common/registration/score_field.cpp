#include "common/registration/score_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/registration/simd.hpp"

namespace liloc {
namespace {

constexpr double kMostCells = 8e6;    // of a plane
constexpr float kSameWay = 0.5F;      // cosine up to which a surface enters the plane of a direction
constexpr float kUpright = 0.7F;      // |z| of a normal from which a surface counts as horizontal
constexpr double kMostBits = 5.6;     // told by a rare surface: a fiftieth of its layer
constexpr double kLeastWeight = 0.1;  // of one that is everywhere
constexpr int kReadAhead = 31;        // rows are read in blocks of 32

/// The direction that a plane stands for.
Eigen::Vector3f direction_of(int plane) {
  if (plane == ScoreField::kUp) return Eigen::Vector3f::UnitZ();
  if (plane == ScoreField::kDown) return -Eigen::Vector3f::UnitZ();
  const auto azimuth = static_cast<float>(2 * M_PI * plane / ScoreField::kAzimuths);
  return {std::cos(azimuth), std::sin(azimuth), 0.0F};
}

/// The planes that a surface with this normal enters; null: all.
void planes_of(const Eigen::Vector3f* normal, std::vector<int>* planes) {
  static const auto kDirectionOf = [] {
    std::array<Eigen::Vector3f, ScoreField::kDirections> all;
    for (int plane = 0; plane < ScoreField::kDirections; ++plane)
      all[static_cast<std::size_t>(plane)] = direction_of(plane);
    return all;
  }();
  planes->assign(1, ScoreField::kAny);
  for (int plane = 0; plane < ScoreField::kDirections; ++plane)
    if (normal == nullptr || normal->dot(kDirectionOf[static_cast<std::size_t>(plane)]) > kSameWay)
      planes->push_back(plane);
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

ScoreField::ScoreField(const Cloud& cloud_map, const std::vector<SightView>& views, const FieldOptions& options)
    : pad_(options.pad) {
  Eigen::AlignedBox3f box;
  for (const auto& p : cloud_map.points)
    if (p.allFinite()) box.extend(p);
  if (box.isEmpty()) return;
  const Eigen::Vector3d size_m = (box.sizes().array() + 4 * static_cast<float>(options.cell_m)).cast<double>();
  const double cells = size_m.prod() / std::pow(options.cell_m, 3);
  cell_ = cells > kMostCells ? options.cell_m * std::cbrt(cells / kMostCells) : options.cell_m;
  inverse_ = static_cast<float>(1.0 / cell_);
  origin_ = box.min().array() - 2 * static_cast<float>(cell_);
  size_ = (size_m.cast<float>() * inverse_).array().ceil().cast<int>();
  extent_ = size_.cast<float>();
  stride_ = size_.x() + 2 * pad_;
  cells_.assign(index(0, 0, 0, kAny + 1) + kReadAhead, 0);
  add_surfaces(cloud_map, options.surface_sd_m);
  mark_free_space(views, options.free);
  weigh_surfaces();
}

void ScoreField::add_surfaces(const Cloud& cloud_map, double surface_sd_m) {
  const bool facing = cloud_map.has_normals();
  std::vector<int> planes;
  for (std::size_t i = 0; i < cloud_map.size(); ++i) {
    if (!cloud_map.points[i].allFinite()) continue;
    planes_of(facing ? &cloud_map.normals[i] : nullptr, &planes);
    add_surface((cloud_map.points[i] - origin_).array(), planes, surface_sd_m);
  }
}

void ScoreField::add_surface(const Eigen::Array3f& q_m, const std::vector<int>& planes, double surface_sd_m) {
  const auto cell = static_cast<float>(cell_);
  const auto reach = static_cast<float>(2.2 * surface_sd_m);
  const auto exponent = static_cast<float>(-0.5 / (surface_sd_m * surface_sd_m));
  const Eigen::Vector3i lo = ((q_m - reach) * inverse_).floor().cast<int>().max(0);
  const Eigen::Vector3i hi = ((q_m + reach) * inverse_).cast<int>().min(size_.array() - 1);
  for (int z = lo.z(); z <= hi.z(); ++z)
    for (int y = lo.y(); y <= hi.y(); ++y)
      for (int x = lo.x(); x <= hi.x(); ++x) {
        const Eigen::Array3f centre = (Eigen::Array3f(x, y, z) + 0.5F) * cell;
        const float squared = (centre - q_m).square().sum();
        if (squared > reach * reach) continue;
        const auto value = static_cast<std::int8_t>(std::lround(kSurface * std::exp(exponent * squared)));
        for (const int plane : planes) {
          std::int8_t& held = cells_[index(x, y, z, plane)];
          held = std::max(held, value);
        }
      }
}

void ScoreField::mark_free_space(const std::vector<SightView>& views, int worth) {
  const auto tolerance = static_cast<float>(0.5 * cell_ + 0.03);
  for (int z = 0; z < size_.z(); ++z)
    for (int y = 0; y < size_.y(); ++y)
      for (int x = 0; x < size_.x(); ++x) {
        std::int8_t& any = cells_[index(x, y, z, kAny)];
        if (any != 0) continue;
        const Eigen::Vector3f centre =
            origin_ + (Eigen::Vector3f(x, y, z).array() + 0.5F).matrix() * static_cast<float>(cell_);
        if (std::none_of(views.begin(), views.end(), [&](const SightView& view) {
              return view.look(centre, tolerance) == Sight::conflict;
            }))
          continue;
        any = -kSurface;
        for (int plane = 0; plane < kDirections; ++plane)
          cells_[index(x, y, z, plane)] = static_cast<std::int8_t>(worth);
      }
}

/// A hit on what covers the share q of a layer tells -log2(q) bits.
void ScoreField::weigh_surfaces() {
  const std::size_t layer = static_cast<std::size_t>(size_.y()) * static_cast<std::size_t>(stride_);
  for (int z = 0; z < size_.z(); ++z) {
    const std::int8_t* any = cells_.data() + index(-pad_, 0, z, kAny);
    const auto seen = std::count_if(any, any + layer, [](std::int8_t v) { return v != 0; });
    for (int plane = 0; plane < kDirections; ++plane) {
      std::int8_t* cells = cells_.data() + index(-pad_, 0, z, plane);
      const auto covered = std::count_if(cells, cells + layer, [](std::int8_t v) { return v > kSurface / 2; });
      const double share = (static_cast<double>(covered) + 1) / (static_cast<double>(seen) + 2);
      const double weight = std::clamp(-std::log2(share) / kMostBits, kLeastWeight, 1.0);
      for (std::size_t i = 0; i < layer; ++i)
        if (cells[i] > 0) cells[i] = static_cast<std::int8_t>(std::lround(weight * cells[i]));
    }
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

void ScoreField::forget_free_space(const std::vector<std::uint8_t>& cells) {
  std::size_t i = 0;
  for (int z = 0; z < size_.z(); ++z)
    for (int y = 0; y < size_.y(); ++y)
      for (int x = 0; x < size_.x(); ++x)
        if (cells[i++] != 0)
          for (int plane = 0; plane <= kAny; ++plane) {
            std::int8_t& held = cells_[index(x, y, z, plane)];
            held = std::max<std::int8_t>(held, 0);
          }
}

}  // namespace liloc
