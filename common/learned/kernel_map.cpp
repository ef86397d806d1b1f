#include "common/learned/kernel_map.hpp"

#include <algorithm>
#include <cassert>
#include <utility>

#include "common/base/parallel.hpp"

namespace liloc::learned {
namespace {

using Neighbor = VoxelNeighbors::Neighbor;

/// The pairs of one block of outputs, and where those of each offset begin.
struct BlockPairs {
  std::vector<KernelMap::Pair> pairs;
  std::vector<std::uint32_t> begins;
};

/// Sorts by offset; what has the same keeps its order.
BlockPairs by_offset(const std::vector<Neighbor>& found, const std::vector<std::uint32_t>& outputs,
                     std::size_t volume) {
  BlockPairs result{std::vector<KernelMap::Pair>(found.size()), std::vector<std::uint32_t>(volume + 1, 0)};
  for (const Neighbor& n : found) ++result.begins[n.offset + 1];
  for (std::size_t k = 0; k < volume; ++k) result.begins[k + 1] += result.begins[k];
  std::vector<std::uint32_t> next(result.begins.begin(), result.begins.end() - 1);
  for (std::size_t i = 0; i < found.size(); ++i)
    result.pairs[next[found[i].offset]++] = {found[i].row, outputs[i]};
  return result;
}

/// Each block goes as soon as its pairs are in the map, so that all of them are never held twice.
KernelMap joined(std::vector<BlockPairs>&& blocks, std::size_t inputs, std::size_t outputs,
                 std::size_t volume) {
  KernelMap map;
  map.inputs = inputs;
  map.outputs = outputs;
  map.volume = volume;
  std::size_t total = 0;
  for (const BlockPairs& block : blocks) total += block.pairs.size();
  map.pairs.reserve(total);
  map.begins.reserve(blocks.size() * volume + 1);
  for (BlockPairs& filled : blocks) {
    const BlockPairs block = std::move(filled);
    const auto base = static_cast<std::uint32_t>(map.pairs.size());
    map.pairs.insert(map.pairs.end(), block.pairs.begin(), block.pairs.end());
    for (std::size_t k = 1; k <= volume; ++k) map.begins.push_back(base + block.begins[k]);
  }
  return map;
}

KernelMap map_of(const VoxelSet& input, const VoxelSet& output, int scale, int width, int threads) {
  assert(width % 2 == 1 && width / 2 <= VoxelNeighbors::kMostRadius);
  const auto volume = static_cast<std::size_t>(width * width * width);
  constexpr std::size_t kRows = KernelMap::kBlockRows;
  std::vector<BlockPairs> blocks((output.size() + kRows - 1) / kRows);
  for_each_index(blocks.size(), threads, [&](std::size_t b) {
    VoxelNeighbors neighbors(input);
    std::vector<Neighbor> found;
    std::vector<std::uint32_t> outputs;
    for (std::size_t row = b * kRows; row < std::min(output.size(), (b + 1) * kRows); ++row) {
      neighbors.around(output, row, scale, width / 2, &found);
      outputs.resize(found.size(), static_cast<std::uint32_t>(row));
    }
    blocks[b] = by_offset(found, outputs, volume);
  });
  return joined(std::move(blocks), input.size(), output.size(), volume);
}

}  // namespace

KernelMap same_map(const VoxelSet& set, int width, int threads) {
  return map_of(set, set, 1, width, threads);
}

KernelMap down_map(const VoxelSet& fine, const VoxelSet& coarse, int width, int threads) {
  return map_of(fine, coarse, 2, width, threads);
}

KernelMap transposed(const KernelMap& map) {
  std::vector<std::uint32_t> begins(map.inputs + 1, 0);  // of the pairs of each input
  for (const KernelMap::Pair& p : map.pairs) ++begins[p.input + 1];
  for (std::size_t row = 0; row < map.inputs; ++row) begins[row + 1] += begins[row];
  std::vector<Neighbor> all(map.pairs.size());
  std::vector<std::uint32_t> next(begins.begin(), begins.end() - 1);
  for (std::size_t i = 0; i + 1 < map.begins.size(); ++i)
    for (std::uint32_t p = map.begins[i]; p < map.begins[i + 1]; ++p)
      all[next[map.pairs[p].input]++] = {static_cast<std::uint32_t>(i % map.volume), map.pairs[p].output};
  std::vector<BlockPairs> blocks;
  for (std::size_t begin = 0; begin < map.inputs; begin += KernelMap::kBlockRows) {
    const std::size_t end = std::min(map.inputs, begin + KernelMap::kBlockRows);
    const std::vector<Neighbor> found(all.begin() + begins[begin], all.begin() + begins[end]);
    std::vector<std::uint32_t> outputs;
    for (std::size_t row = begin; row < end; ++row)
      outputs.resize(begins[row + 1] - begins[begin], static_cast<std::uint32_t>(row));
    blocks.push_back(by_offset(found, outputs, map.volume));
  }
  return joined(std::move(blocks), map.outputs, map.inputs, map.volume);
}

}  // namespace liloc::learned
