#include "common/geometry/voxel.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <optional>
#include <utility>

namespace liloc {
namespace {

constexpr std::uint64_t kEmpty = ~std::uint64_t{0};

struct Sum {
  Eigen::Vector3i cell;
  Eigen::Vector3f point = Eigen::Vector3f::Zero(), normal = Eigen::Vector3f::Zero();
  float count = 0;
};

/// Open addressing from cell key to index; sized once, never deletes.
class CellTable {
 public:
  explicit CellTable(std::size_t items) : keys_(std::bit_ceil(items * 2 + 16), kEmpty), values_(keys_.size()) {}

  /// The value stored for `key`, if any.
  [[nodiscard]] std::optional<std::uint32_t> find(std::uint64_t key) const {
    std::size_t slot = slot_of(key);
    while (keys_[slot] != key) {
      if (keys_[slot] == kEmpty) return std::nullopt;
      slot = (slot + 1) & (keys_.size() - 1);
    }
    return values_[slot];
  }

  /// The value stored for `key`, or `fresh` after storing it.
  std::uint32_t find_or_insert(std::uint64_t key, std::uint32_t fresh) {
    std::size_t slot = slot_of(key);
    while (keys_[slot] != key) {
      if (keys_[slot] == kEmpty) {
        keys_[slot] = key;
        values_[slot] = fresh;
        return fresh;
      }
      slot = (slot + 1) & (keys_.size() - 1);
    }
    return values_[slot];
  }

 private:
  [[nodiscard]] std::size_t slot_of(std::uint64_t key) const {
    return (key * 0x9E3779B97F4A7C15ULL) >> (64 - std::countr_zero(keys_.size()));
  }
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> values_;
};

/// Sums of the points in each occupied voxel, in the order in which the voxels are first entered.
struct Voxels {
  Voxels(const Cloud& cloud, float inverse) : table(cloud.size()) {
    const bool with_normals = cloud.has_normals();
    sums.reserve(cloud.size() / 4 + 16);
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Eigen::Vector3f& p = cloud.points[i];
      if (!p.allFinite()) continue;
      const auto fresh = static_cast<std::uint32_t>(sums.size());
      const Eigen::Vector3i cell = cell_of(p, inverse);
      const std::uint32_t index = table.find_or_insert(cell_key(cell), fresh);
      if (index == fresh) sums.push_back({cell});
      Sum& sum = sums[index];
      sum.point += p;
      if (with_normals) sum.normal += cloud.normals[i];
      sum.count += 1;
    }
  }
  CellTable table;
  std::vector<Sum> sums;
};

}  // namespace

Cloud voxel_downsample(const Cloud& cloud, double voxel_size_m) {
  assert(voxel_size_m > 0);
  const Voxels voxels(cloud, static_cast<float>(1.0 / voxel_size_m));
  Cloud thin;
  thin.points.reserve(voxels.sums.size());
  for (const Sum& sum : voxels.sums) thin.points.push_back(sum.point / sum.count);
  if (cloud.has_normals()) {
    thin.normals.reserve(voxels.sums.size());
    for (const Sum& sum : voxels.sums) thin.normals.push_back(sum.normal.stableNormalized());
  }
  return thin;
}

Cloud fullest_voxels(const Cloud& cloud, double voxel_size_m, std::size_t most_points) {
  assert(voxel_size_m > 0);
  static const std::array<Eigen::Vector3i, 6> kFaces{Eigen::Vector3i{1, 0, 0}, Eigen::Vector3i{-1, 0, 0},
                                                     Eigen::Vector3i{0, 1, 0}, Eigen::Vector3i{0, -1, 0},
                                                     Eigen::Vector3i{0, 0, 1}, Eigen::Vector3i{0, 0, -1}};
  const Voxels voxels(cloud, static_cast<float>(1.0 / voxel_size_m));
  std::vector<std::pair<float, std::uint32_t>> by_share;  // how much fuller its fullest neighbour is
  by_share.reserve(voxels.sums.size());
  for (std::uint32_t i = 0; i < voxels.sums.size(); ++i) {
    float fullest = 0;
    if (voxels.sums.size() > most_points)
      for (const Eigen::Vector3i& face : kFaces)
        if (const auto j = voxels.table.find(cell_key(voxels.sums[i].cell + face)))
          fullest = std::max(fullest, voxels.sums[*j].count);
    by_share.emplace_back(fullest / voxels.sums[i].count, i);
  }
  if (by_share.size() > most_points) {
    std::nth_element(by_share.begin(), by_share.begin() + static_cast<std::ptrdiff_t>(most_points),
                     by_share.end());
    by_share.resize(most_points);
  }
  Cloud thin;
  thin.points.reserve(by_share.size());
  for (const auto& [share, i] : by_share) thin.points.push_back(voxels.sums[i].point / voxels.sums[i].count);
  return thin;
}

}  // namespace liloc
