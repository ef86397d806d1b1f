#pragma once
#include <cstdint>
#include <vector>

#include "common/learned/voxel_set.hpp"

namespace liloc::learned {

/// Which input rows a convolution multiplies by which of its matrices into which output rows. One serves all
/// layers between the same two sets with the same kernel. Immutable; any thread may read it.
struct KernelMap {
  /// Outputs are worked off in blocks, so that what is summed up stays in the second-level cache: 256 channels
  /// of 256 rows are 256 KiB. By measurement: DECISIONS.md.
  static constexpr std::size_t kBlockRows = 256;

  struct Pair {
    std::uint32_t input = 0, output = 0;  ///< rows
  };
  std::vector<Pair> pairs;  ///< by block of outputs, of these by offset, of these by output
  /// Where the pairs of block b and offset k begin: at b * volume + k; one more at the end.
  std::vector<std::uint32_t> begins = {0};
  std::size_t inputs = 0, outputs = 0;  ///< rows
  std::size_t volume = 1;               ///< offsets of the kernel, x fastest, each axis from the lowest

  [[nodiscard]] std::size_t blocks() const { return (outputs + kBlockRows - 1) / kBlockRows; }
};

/// Stride 1: output and input are the same set. `width`: of the kernel, odd, up to 7.
[[nodiscard]] KernelMap same_map(const VoxelSet& set, int width, int threads);

/// Stride 2: outputs are `coarse`, which is `fine` halved; the kernel is centred on twice the output.
[[nodiscard]] KernelMap down_map(const VoxelSet& fine, const VoxelSet& coarse, int width, int threads);

/// What turns a map round: its inputs become outputs, at the same offsets. Of a `down_map` it is that of the
/// transposed convolution.
[[nodiscard]] KernelMap transposed(const KernelMap& map);

}  // namespace liloc::learned
