#include "common/geometry/voxel.hpp"

#include <bit>
#include <cassert>

namespace liloc {
namespace {

constexpr std::uint64_t kEmpty = ~std::uint64_t{0};

struct Sum {
  Eigen::Vector3f point = Eigen::Vector3f::Zero(), normal = Eigen::Vector3f::Zero();
  float count = 0;
};

/// Open addressing from cell key to index; sized once, never deletes.
class CellTable {
 public:
  explicit CellTable(std::size_t items) : keys_(std::bit_ceil(items * 2 + 16), kEmpty), values_(keys_.size()) {}

  /// The value stored for `key`, or `fresh` after storing it.
  std::uint32_t find_or_insert(std::uint64_t key, std::uint32_t fresh) {
    std::size_t slot = (key * 0x9E3779B97F4A7C15ULL) >> (64 - std::countr_zero(keys_.size()));
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
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> values_;
};

}  // namespace

Cloud voxel_downsample(const Cloud& cloud, double voxel_size_m) {
  assert(voxel_size_m > 0);
  const auto inverse = static_cast<float>(1.0 / voxel_size_m);
  const bool with_normals = cloud.has_normals();
  CellTable table(cloud.size());
  std::vector<Sum> sums;
  sums.reserve(cloud.size() / 4 + 16);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3f& p = cloud.points[i];
    if (!p.allFinite()) continue;
    const auto fresh = static_cast<std::uint32_t>(sums.size());
    const std::uint32_t index = table.find_or_insert(cell_key(cell_of(p, inverse)), fresh);
    if (index == fresh) sums.emplace_back();
    Sum& sum = sums[index];
    sum.point += p;
    if (with_normals) sum.normal += cloud.normals[i];
    sum.count += 1;
  }
  Cloud thin;
  thin.points.reserve(sums.size());
  for (const Sum& sum : sums) thin.points.push_back(sum.point / sum.count);
  if (with_normals) {
    thin.normals.reserve(sums.size());
    for (const Sum& sum : sums) thin.normals.push_back(sum.normal.stableNormalized());
  }
  return thin;
}

}  // namespace liloc
