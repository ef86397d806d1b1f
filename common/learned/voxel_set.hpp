#pragma once
// The occupied voxels of a cloud, in the order in which all of a network's tensors have their rows.
#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "common/base/result.hpp"

namespace liloc::learned {

/// Occupied voxels in Morton order, with a hash of blocks of 4x4x4 to find them by. Immutable; any thread may
/// ask.
class VoxelSet {
 public:
  /// Coordinates lie within +-kReach; half of the range of 20 bits, so that neighbours are in range, too.
  static constexpr int kReach = 1 << 19;
  /// Bounds memory: about 2 GB by the paper's network where every neighbour is there. By measurement:
  /// DECISIONS.md.
  static constexpr std::size_t kMostVoxels = 400'000;

  VoxelSet() = default;
  /// Each voxel once, however often it is given. Errors: a coordinate out of reach, more than kMostVoxels.
  [[nodiscard]] static Result<VoxelSet> of(const std::vector<Eigen::Vector3i>& voxels);

  /// The voxels at twice the size that hold these: coordinates are halved and rounded down.
  [[nodiscard]] VoxelSet halved() const;

  [[nodiscard]] std::size_t size() const { return codes_.size(); }
  [[nodiscard]] Eigen::Vector3i voxel(std::size_t row) const;
  /// The row of a voxel, or -1.
  [[nodiscard]] std::int32_t find(const Eigen::Vector3i& voxel) const;

 private:
  friend class VoxelNeighbors;

  struct Block {
    std::uint64_t key = 0;        ///< Morton code of the block
    std::uint64_t occupied = 0;   ///< bit i: its voxel of Morton code i
    std::uint32_t first_row = 0;  ///< of its voxels
  };

  explicit VoxelSet(std::vector<std::uint64_t> sorted_codes, int bias);
  [[nodiscard]] const Block* block(std::uint64_t key) const;

  std::vector<std::uint64_t> codes_;  ///< of each row, ascending
  int bias_ = 0;                      ///< added to coordinates before they are coded
  std::vector<Block> blocks_;
  std::vector<std::uint32_t> slots_;  ///< open addressing: 1 + block, or 0
};

/// Finds the voxels around others. Remembers the last block's surroundings, so that rows are best asked for in
/// order; one thread each.
class VoxelNeighbors {
 public:
  static constexpr int kMostRadius = 3;

  /// `among` outlives this.
  explicit VoxelNeighbors(const VoxelSet& among) : among_(among) {}

  struct Neighbor {
    std::uint32_t offset = 0;  ///< x + width y + width^2 z of what is added, counted from -radius
    std::uint32_t row = 0;     ///< among the set
  };
  /// The occupied voxels of the cube of `radius`, up to kMostRadius, about the voxel `row` of `of`, whose
  /// voxels are `scale` times those of the set: 1, or 2 for a set that was halved. Appends to `found`.
  void around(const VoxelSet& of, std::size_t row, int scale, int radius, std::vector<Neighbor>* found);

 private:
  void move_to(std::uint64_t key);

  const VoxelSet& among_;
  std::uint64_t key_ = ~std::uint64_t{0};
  const VoxelSet::Block* near_[27] = {};  ///< null: nothing there
};

}  // namespace liloc::learned
