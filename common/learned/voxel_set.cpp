#include "common/learned/voxel_set.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>

#include "common/learned/morton.hpp"

namespace liloc::learned {
namespace {

constexpr int kBlockBits = 6;  // of a Morton code: 4x4x4 voxels
constexpr int kSide = 4;
constexpr int kBias = 1 << 20;  // of coordinates, so that codes are of positive numbers

std::size_t hash(std::uint64_t key) {
  return static_cast<std::size_t>((key * 0x9E3779B97F4A7C15U) >> 20);  // Knuth's multiplicative hash
}

/// Of each axis the voxels of a block whose coordinate on it is 0, 1, 2 and 3.
constexpr std::array<std::array<std::uint64_t, kSide>, 3> slices() {
  std::array<std::array<std::uint64_t, kSide>, 3> result{};
  for (std::uint32_t i = 0; i < 64; ++i) {
    const Morton m = morton_decoded(i);
    result[0][m.x] |= std::uint64_t{1} << i;
    result[1][m.y] |= std::uint64_t{1} << i;
    result[2][m.z] |= std::uint64_t{1} << i;
  }
  return result;
}
constexpr auto kSlices = slices();

/// The voxels of a block whose coordinate on `axis` is in low..high, which may reach beyond it.
std::uint64_t slab(std::size_t axis, int low, int high) {
  std::uint64_t mask = 0;
  for (int i = std::max(low, 0); i <= std::min(high, kSide - 1); ++i)
    mask |= kSlices[axis][static_cast<std::size_t>(i)];
  return mask;
}

}  // namespace

Result<VoxelSet> VoxelSet::of(const std::vector<Eigen::Vector3i>& voxels) {
  std::vector<std::uint64_t> codes;
  codes.reserve(voxels.size());
  for (const Eigen::Vector3i& v : voxels) {
    if ((v.array() < -kReach).any() || (v.array() > kReach).any())
      return fail("voxel ({}, {}, {}) is out of reach; coordinates go to +-{}", v.x(), v.y(), v.z(), kReach);
    const auto biased = (v.array() + kBias).cast<std::uint32_t>();
    codes.push_back(morton_code({biased.x(), biased.y(), biased.z()}));
  }
  std::ranges::sort(codes);
  codes.erase(std::unique(codes.begin(), codes.end()), codes.end());
  if (codes.size() > kMostVoxels)
    return fail("the cloud has {} voxels, of at most {}; give larger voxels", codes.size(), kMostVoxels);
  return VoxelSet(std::move(codes), kBias);
}

VoxelSet::VoxelSet(std::vector<std::uint64_t> sorted_codes, int bias)
    : codes_(std::move(sorted_codes)), bias_(bias) {
  for (std::uint32_t row = 0; row < codes_.size(); ++row) {
    const std::uint64_t key = codes_[row] >> kBlockBits;
    if (blocks_.empty() || blocks_.back().key != key) blocks_.push_back({key, 0, row});
    blocks_.back().occupied |= std::uint64_t{1} << (codes_[row] & 63);
  }
  slots_.assign(std::bit_ceil(2 * blocks_.size() + 1), 0);
  for (std::uint32_t i = 0; i < blocks_.size(); ++i) {
    std::size_t slot = hash(blocks_[i].key) & (slots_.size() - 1);
    while (slots_[slot] != 0) slot = (slot + 1) & (slots_.size() - 1);
    slots_[slot] = i + 1;
  }
}

VoxelSet VoxelSet::halved() const {
  std::vector<std::uint64_t> codes;
  for (const std::uint64_t code : codes_)
    if (codes.empty() || codes.back() != code >> 3) codes.push_back(code >> 3);
  return VoxelSet(std::move(codes), bias_ / 2);
}

Eigen::Vector3i VoxelSet::voxel(std::size_t row) const {
  const Morton m = morton_decoded(codes_[row]);
  return Eigen::Vector3i(static_cast<int>(m.x), static_cast<int>(m.y), static_cast<int>(m.z)).array() - bias_;
}

const VoxelSet::Block* VoxelSet::block(std::uint64_t key) const {
  for (std::size_t slot = hash(key) & (slots_.size() - 1); slots_[slot] != 0;
       slot = (slot + 1) & (slots_.size() - 1))
    if (blocks_[slots_[slot] - 1].key == key) return &blocks_[slots_[slot] - 1];
  return nullptr;
}

std::int32_t VoxelSet::find(const Eigen::Vector3i& voxel) const {
  if (codes_.empty() || (voxel.array() < -bias_).any() || (voxel.array() >= bias_).any()) return -1;
  const auto biased = (voxel.array() + bias_).cast<std::uint32_t>();
  const std::uint64_t code = morton_code({biased.x(), biased.y(), biased.z()});
  const Block* found = block(code >> kBlockBits);
  const std::uint64_t bit = std::uint64_t{1} << (code & 63);
  if (found == nullptr || (found->occupied & bit) == 0) return -1;
  return static_cast<std::int32_t>(found->first_row) + std::popcount(found->occupied & (bit - 1));
}

void VoxelNeighbors::move_to(std::uint64_t key) {
  key_ = key;
  const Morton at = morton_decoded(key);
  for (std::uint32_t i = 0; i < 27; ++i)
    near_[i] = among_.block(morton_code({at.x + i % 3 - 1, at.y + i / 3 % 3 - 1, at.z + i / 9 - 1}));
}

void VoxelNeighbors::around(const VoxelSet& of, std::size_t row, int scale, int radius,
                            std::vector<Neighbor>* found) {
  assert(radius <= kMostRadius && (scale == 1 || scale == 2) && of.bias_ * scale == among_.bias_);
  const std::uint64_t center = scale == 1 ? of.codes_[row] : of.codes_[row] << 3;
  if (center >> kBlockBits != key_) move_to(center >> kBlockBits);
  const Morton local = morton_decoded(center & 63);
  const int x = static_cast<int>(local.x), y = static_cast<int>(local.y), z = static_cast<int>(local.z);
  const int width = 2 * radius + 1;
  for (int i = 0; i < 27; ++i) {
    const VoxelSet::Block* block = near_[i];
    if (block == nullptr) continue;
    // The centre, as the block counts.
    const int bx = x - kSide * (i % 3 - 1), by = y - kSide * (i / 3 % 3 - 1), bz = z - kSide * (i / 9 - 1);
    std::uint64_t left = block->occupied & slab(0, bx - radius, bx + radius) &
                         slab(1, by - radius, by + radius) & slab(2, bz - radius, bz + radius);
    for (; left != 0; left &= left - 1) {
      const int bit = std::countr_zero(left);
      const Morton m = morton_decoded(static_cast<std::uint64_t>(bit));
      const int dx = static_cast<int>(m.x) - bx + radius, dy = static_cast<int>(m.y) - by + radius,
                dz = static_cast<int>(m.z) - bz + radius;
      const std::uint64_t below = block->occupied & ((std::uint64_t{1} << bit) - 1);
      found->push_back({static_cast<std::uint32_t>(dx + width * (dy + width * dz)),
                        block->first_row + static_cast<std::uint32_t>(std::popcount(below))});
    }
  }
}

}  // namespace liloc::learned
