#include "common/geometry/voxel.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <optional>
#include <tuple>
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

constexpr int kBlockBits = 2;               // blocks of 4 x 4 x 4 voxels
constexpr std::size_t kVoxelsOfBlock = 64;  // 4 x 4 x 4

/// A voxel in the order in which a block's voxels are kept: every other one first, as on a chessboard, then the
/// fuller ones.
struct Ranked {
  std::uint64_t block;
  std::uint32_t odd;
  float emptiness;
  std::uint32_t index;
  bool operator<(const Ranked& o) const {
    return std::tie(block, odd, emptiness, index) < std::tie(o.block, o.odd, o.emptiness, o.index);
  }
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

Cloud voxel_downsample(const Cloud& cloud, double voxel_size_m, std::size_t most_points) {
  assert(voxel_size_m > 0);
  const Voxels voxels(cloud, static_cast<float>(1.0 / voxel_size_m));
  std::vector<Ranked> ranked;
  ranked.reserve(voxels.sums.size());
  for (std::uint32_t i = 0; i < voxels.sums.size(); ++i) {
    const Sum& sum = voxels.sums[i];
    const Eigen::Vector3i block = sum.cell.unaryExpr([](int c) { return c >> kBlockBits; });
    ranked.push_back({cell_key(block), static_cast<std::uint32_t>(sum.cell.sum() & 1), 1 / sum.count, i});
  }
  std::sort(ranked.begin(), ranked.end());
  std::vector<std::uint32_t> place(ranked.size(), 0);      // within the block, from 0
  std::array<std::size_t, kVoxelsOfBlock + 1> of_place{};  // how many voxels have it
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    if (i > 0 && ranked[i].block == ranked[i - 1].block) place[i] = place[i - 1] + 1;
    ++of_place[place[i]];
  }
  std::size_t allowed = 0, kept = 0;
  while (allowed < kVoxelsOfBlock && kept + of_place[allowed] <= most_points) kept += of_place[allowed++];
  std::size_t every = 1;  // of so many blocks one keeps anything: there are more blocks than points
  if (allowed == 0 && most_points > 0) {
    allowed = 1;
    every = (of_place[0] + most_points - 1) / most_points;
    kept = most_points;
  }
  Cloud thin;
  thin.points.reserve(kept);
  std::size_t blocks = 0;
  for (std::size_t i = 0; i < ranked.size(); ++i) {
    blocks += place[i] == 0 ? 1 : 0;
    if (place[i] < allowed && (blocks - 1) % every == 0) {
      const Sum& sum = voxels.sums[ranked[i].index];
      thin.points.push_back(sum.point / sum.count);
    }
  }
  return thin;
}

}  // namespace liloc
