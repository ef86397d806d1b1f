#include "common/registration/neighbors.hpp"

#include <algorithm>
#include <array>
#include <bit>

#include "common/registration/simd.hpp"

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

}  // namespace

RadiusSearch::RadiusSearch(const std::vector<Eigen::Vector3f>& points, double radius_m)
    : radius_(static_cast<float>(radius_m)), inverse_(1.0F / radius_), squared_radius_(radius_ * radius_) {
  std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
  order.reserve(points.size());
  for (std::uint32_t i = 0; i < points.size(); ++i)
    if (points[i].allFinite()) order.emplace_back(cell_key(cell_of(points[i], inverse_)), i);
  std::sort(order.begin(), order.end());

  std::size_t cells = 0;
  for (std::size_t i = 0; i < order.size(); ++i) cells += i == 0 || order[i].first != order[i - 1].first;
  table_.assign(std::bit_ceil(cells * 2 + 2), Run{0, 0, 0});
  shift_ = 64 - std::countr_zero(table_.size());

  sorted_.reserve(order.size());
  index_.reserve(order.size());
  for (const auto& [key, i] : order) {
    sorted_.push_back(points[i]);
    index_.push_back(i);
  }
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin;
    while (end < order.size() && order[end].first == order[begin].first) ++end;
    std::size_t slot = (order[begin].first * 0x9E3779B97F4A7C15ULL) >> shift_;
    while (table_[slot].end != 0) slot = (slot + 1) & (table_.size() - 1);
    table_[slot] = {order[begin].first, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
    begin = end;
  }
}

void RadiusSearch::gather(const Eigen::Vector3i& centre, Points* points) const {
  std::array<const Run*, 27> runs{};
  std::size_t found = 0, count = 0;
  for (int dz = -1; dz <= 1; ++dz)
    for (int dy = -1; dy <= 1; ++dy)
      for (int dx = -1; dx <= 1; ++dx)
        if (const Run* run = find(cell_key(centre + Eigen::Vector3i(dx, dy, dz)))) {
          runs[found++] = run;
          count += run->end - run->begin;
        }
  points->index.resize(count);
  for (auto* axis : {&points->x, &points->y, &points->z}) axis->resize(count);
  std::size_t at = 0;
  for (std::size_t r = 0; r < found; ++r)
    for (std::uint32_t i = runs[r]->begin; i < runs[r]->end; ++i, ++at) {
      points->index[at] = index_[i];
      points->x[at] = sorted_[i].x();
      points->y[at] = sorted_[i].y();
      points->z[at] = sorted_[i].z();
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

std::optional<RadiusSearch::Neighbor> RadiusSearch::nearest(const Eigen::Vector3f& query) const {
  std::optional<Neighbor> best;
  for_each(query, [&](std::uint32_t index, float squared) {
    if (!best || squared < best->squared_distance) best = Neighbor{index, squared};
  });
  return best;
}

}  // namespace liloc
