#include "common/registration/points/neighbors.hpp"

#include <algorithm>
#include <utility>

#include "common/registration/points/simd.hpp"

namespace liloc {
namespace {

LILOC_WIDE void squared_distances(const float* xs, const float* ys, const float* zs, std::size_t count, float x,
                                  float y, float z, float* squared) {
#pragma omp simd
  for (std::size_t i = 0; i < count; ++i) {
    const float dx = xs[i] - x, dy = ys[i] - y, dz = zs[i] - z;
    squared[i] = dx * dx + dy * dy + dz * dz;
  }
}

constexpr int kPartBits = 21;  // of an axis in a cell's key; three fit 64 bits
constexpr std::uint64_t kLastPart = (1 << kPartBits) - 1;

std::uint64_t part_of(std::uint64_t key, int axis) {
  return key >> (axis * kPartBits) & kLastPart;
}

void append_run(const RadiusSearch::Points& from, std::uint32_t begin, std::uint32_t end,
                RadiusSearch::Points* to) {
  const auto take = [&](const auto& values, auto* taken) {
    taken->insert(taken->end(), values.begin() + begin, values.begin() + end);
  };
  take(from.index, &to->index);
  take(from.x, &to->x);
  take(from.y, &to->y);
  take(from.z, &to->z);
}

}  // namespace

RadiusSearch::RadiusSearch(const std::vector<Eigen::Vector3f>& points, double radius_m)
    : radius_(static_cast<float>(radius_m)), squared_radius_(radius_ * radius_) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
  order.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (points[i].allFinite()) order.emplace_back(cell_key(cell_of(points[i], 1.0F / radius_)), i);
  std::sort(order.begin(), order.end());
  sorted_.index.reserve(order.size());
  for (auto* axis : {&sorted_.x, &sorted_.y, &sorted_.z}) axis->reserve(order.size());
  for (const auto& [key, i] : order) {
    const auto at = static_cast<std::uint32_t>(sorted_.index.size());
    if (cells_.empty() || cells_.back().key != key) cells_.push_back({key, at, at});
    cells_.back().end = at + 1;
    sorted_.index.push_back(i);
    sorted_.x.push_back(points[i].x());
    sorted_.y.push_back(points[i].y());
    sorted_.z.push_back(points[i].z());
  }
}

void RadiusSearch::gather(const Cell& cell, Rows* rows, Points* points) const {
  const std::uint64_t x = part_of(cell.key, 0), y = part_of(cell.key, 1), z = part_of(cell.key, 2);
  points->index.clear();
  for (auto* axis : {&points->x, &points->y, &points->z}) axis->clear();
  std::size_t row = 0;
  for (std::uint64_t v = z - 1; v != z + 2; ++v)
    for (std::uint64_t u = y - 1; u != y + 2; ++u, ++row) {
      if (u > kLastPart || v > kLastPart) continue;  // the space that a key tells ends here
      const std::uint64_t begin_of_row = u << kPartBits | v << (2 * kPartBits);
      const std::uint64_t first = begin_of_row | (x - (x > 0 ? 1 : 0)),
                          last = begin_of_row | std::min(x + 1, kLastPart);
      std::size_t at = (*rows)[row];
      while (at < cells_.size() && cells_[at].key < first) ++at;
      (*rows)[row] = at;
      if (at == cells_.size() || cells_[at].key > last) continue;
      const std::uint32_t begin = cells_[at].begin;
      while (at < cells_.size() && cells_[at].key <= last) ++at;
      append_run(sorted_, begin, cells_[at - 1].end, points);
    }
}

RadiusSearch::Neighborhood RadiusSearch::select(const Points& points, const Eigen::Vector3f& p,
                                                Selection* near) const {
  const std::size_t count = points.index.size();
  if (near->index.size() < count) {
    near->index.resize(count);
    near->squared.resize(count);
  }
  std::uint32_t* index = near->index.data();
  float* distances = near->squared.data();
  squared_distances(points.x.data(), points.y.data(), points.z.data(), count, p.x(), p.y(), p.z(), distances);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {  // without a branch: which are near is hard to foretell
    const float squared = distances[i];
    index[kept] = points.index[i];
    distances[kept] = squared;
    kept += squared <= squared_radius_ ? 1 : 0;
  }
  return {{index, kept}, {distances, kept}};
}

}  // namespace liloc
