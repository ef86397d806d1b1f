#include "common/learned/kernel_map.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <tuple>

#include "common/learned/tests/random_network.hpp"

namespace liloc::learned {
namespace {

using Triple = std::tuple<std::size_t, std::uint32_t, std::uint32_t>;  // offset, output, input

std::vector<Triple> sorted_triples(const KernelMap& map) {
  std::vector<Triple> triples;
  for (std::size_t i = 0; i + 1 < map.begins.size(); ++i)
    for (std::uint32_t p = map.begins[i]; p < map.begins[i + 1]; ++p)
      triples.emplace_back(i % map.volume, map.pairs[p].output, map.pairs[p].input);
  std::ranges::sort(triples);
  return triples;
}

/// By asking for every voxel.
std::vector<Triple> expected(const VoxelSet& input, const VoxelSet& output, int scale, int width) {
  std::vector<Triple> triples;
  for (std::uint32_t row = 0; row < output.size(); ++row)
    for (int k = 0; k < width * width * width; ++k) {
      const Eigen::Vector3i index(k % width, k / width % width, k / width / width);
      const Eigen::Vector3i at = scale * output.voxel(row) + Eigen::Vector3i(index.array() - width / 2);
      if (const std::int32_t found = input.find(at); found >= 0)
        triples.emplace_back(static_cast<std::size_t>(k), row, static_cast<std::uint32_t>(found));
    }
  std::ranges::sort(triples);
  return triples;
}

/// Begins of every block and offset, and in each the outputs of that block, ascending.
void expect_in_order(const KernelMap& map) {
  ASSERT_EQ(map.begins.size(), map.blocks() * map.volume + 1);
  EXPECT_EQ(map.begins.front(), 0U);
  EXPECT_EQ(map.begins.back(), map.pairs.size());
  for (std::size_t i = 0; i + 1 < map.begins.size(); ++i)
    for (std::uint32_t p = map.begins[i]; p < map.begins[i + 1]; ++p) {
      EXPECT_EQ(map.pairs[p].output / KernelMap::kBlockRows, i / map.volume);
      if (p > map.begins[i]) {
        EXPECT_LT(map.pairs[p - 1].output, map.pairs[p].output);
      }
    }
}

class KernelMapLaw : public testing::TestWithParam<std::uint64_t> {
 protected:
  const VoxelSet fine = *VoxelSet::of(random_voxels(GetParam(), 10, 1200));
  const VoxelSet coarse = fine.halved();
};

TEST_P(KernelMapLaw, SameIsWhatEveryVoxelSays) {
  for (const int width : {1, 3, 5, 7}) {
    const KernelMap map = same_map(fine, width, 1);
    EXPECT_EQ(sorted_triples(map), expected(fine, fine, 1, width)) << width;
    expect_in_order(map);
  }
}

TEST_P(KernelMapLaw, DownIsCentredOnTwiceTheOutput) {
  const KernelMap map = down_map(fine, coarse, 3, 1);
  EXPECT_EQ(map.inputs, fine.size());
  EXPECT_EQ(map.outputs, coarse.size());
  EXPECT_EQ(sorted_triples(map), expected(fine, coarse, 2, 3));
  expect_in_order(map);
}

TEST_P(KernelMapLaw, TransposedHasTheSamePairsTurnedRound) {
  const KernelMap down = down_map(fine, coarse, 3, 1), up = transposed(down);
  EXPECT_EQ(up.inputs, coarse.size());
  EXPECT_EQ(up.outputs, fine.size());
  std::vector<Triple> turned;
  for (const auto& [offset, output, input] : sorted_triples(down)) turned.emplace_back(offset, input, output);
  std::ranges::sort(turned);
  EXPECT_EQ(sorted_triples(up), turned);
  expect_in_order(up);
}

TEST_P(KernelMapLaw, ThreadsChangeNothing) {
  const KernelMap one = same_map(fine, 5, 1), four = same_map(fine, 5, 4);
  EXPECT_EQ(one.begins, four.begins);
  EXPECT_EQ(sorted_triples(one), sorted_triples(four));
}

INSTANTIATE_TEST_SUITE_P(Seeds, KernelMapLaw, testing::Range<std::uint64_t>(1, 4));

TEST(KernelMap, OfNothingIsEmpty) {
  const VoxelSet none = *VoxelSet::of({});
  for (const KernelMap& map :
       {same_map(none, 3, 2), down_map(none, none, 3, 2), transposed(same_map(none, 3, 1))}) {
    EXPECT_TRUE(map.pairs.empty());
    EXPECT_EQ(map.blocks(), 0U);
  }
}

}  // namespace
}  // namespace liloc::learned
