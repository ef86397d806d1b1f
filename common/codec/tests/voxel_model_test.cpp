#include "common/codec/voxel_model.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <map>
#include <random>
#include <set>

namespace liloc::codec {
namespace {

class VoxelModelLaw : public testing::TestWithParam<unsigned> {};

std::vector<CellId> dense_cells(std::mt19937_64& rng) {
  std::set<CellId> cells;
  for (int i = 0; i < 900; ++i) cells.insert(cell_id(rng() % 12, rng() % 12, rng() % 12));
  return {cells.begin(), cells.end()};
}

/// By asking each of the 26 neighbours; those of faces and edges tell, and of an offset those before.
std::array<Foretold, 3> slowly_foretold(const std::map<CellId, Offset>& known, CellId leaf, int steps) {
  std::array<Foretold, 3> of{};
  for (int k = 0; k < 27; ++k) {
    const std::array<int, 3> step{k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
    const int away = std::abs(step[0]) + std::abs(step[1]) + std::abs(step[2]);
    if (away == 0 || away == 3) continue;
    const auto moved = [&](int axis) {
      return coordinate(leaf, axis) + static_cast<std::uint64_t>(step[static_cast<std::size_t>(axis)]);
    };
    const auto found = known.find(cell_id(moved(0), moved(1), moved(2)));
    if (found == known.end()) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      (away == 2 ? of[axis].edges : of[axis].sides) += step[axis];
      if (found->first < leaf && step[axis] == 0)
        (away == 2 ? of[axis].edge_offsets : of[axis].side_offsets) += 2 * found->second[axis] - (steps - 1);
    }
  }
  return of;
}

TEST_P(VoxelModelLaw, ForesightIsWhatAllNeighboursTell) {
  constexpr int kSteps = 17;
  std::mt19937_64 rng(GetParam());
  const std::vector<CellId> leaves = dense_cells(rng);
  std::vector<Offset> offsets(leaves.size());
  std::map<CellId, Offset> known;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    for (std::uint8_t& o : offsets[i]) o = static_cast<std::uint8_t>(rng() % kSteps);
    known[leaves[i]] = offsets[i];
  }
  Foresight foresight(leaves, kSteps);
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    const auto got = foresight(i, offsets), expected = slowly_foretold(known, leaves[i], kSteps);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ASSERT_EQ(got[axis].sides, expected[axis].sides) << i;
      ASSERT_EQ(got[axis].edges, expected[axis].edges) << i;
      ASSERT_EQ(got[axis].side_offsets, expected[axis].side_offsets) << i;
      ASSERT_EQ(got[axis].edge_offsets, expected[axis].edge_offsets) << i;
    }
  }
}

TEST_P(VoxelModelLaw, OccupancyReadsBackWhatItWrote) {
  std::mt19937_64 rng(GetParam());
  const std::vector<CellId> cells = dense_cells(rng);
  std::vector<std::uint8_t> masks(cells.size()), none(cells.size());
  for (std::uint8_t& mask : masks) mask = static_cast<std::uint8_t>(1 + rng() % 255);  // no cell is empty
  for (const int above_leaves : {0, 1, 2, 7}) {
    RangeEncoder encoder;
    std::vector<std::uint8_t> written = masks;
    OccupancyModel().code(encoder, cells, written, above_leaves);
    EXPECT_EQ(written, masks);
    const std::vector<std::uint8_t> bytes = encoder.finish();
    RangeDecoder decoder(bytes.data(), bytes.data() + bytes.size());
    std::vector<std::uint8_t> read = none;
    OccupancyModel().code(decoder, cells, read, above_leaves);
    EXPECT_EQ(read, masks);
    EXPECT_TRUE(decoder.used_up());
  }
}

TEST_P(VoxelModelLaw, OffsetsOfAnyNumberOfStepsReadBack) {
  for (const int steps : {1, 2, 3, 17, kMaxSteps}) {
    std::mt19937_64 rng(GetParam());
    std::vector<Offset> offsets(500);
    std::vector<std::array<Foretold, 3>> foretold(500);
    for (std::size_t i = 0; i < offsets.size(); ++i)
      for (std::size_t axis = 0; axis < 3; ++axis) {
        offsets[i][axis] = static_cast<std::uint8_t>(rng() % static_cast<unsigned>(steps));
        foretold[i][axis] = {static_cast<int>(rng() % 3) - 1, static_cast<int>(rng() % 9) - 4,
                             static_cast<int>(rng() % 200) - 100, static_cast<int>(rng() % 200) - 100};
      }
    RangeEncoder encoder;
    OffsetModel writer(steps), reader(steps);
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      writer.code(encoder, foretold[i], offsets[i]);
      writer.code_again(encoder, i % 5 == 0);
    }
    const std::vector<std::uint8_t> bytes = encoder.finish();
    RangeDecoder decoder(bytes.data(), bytes.data() + bytes.size());
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      ASSERT_EQ(reader.code(decoder, foretold[i], {}), offsets[i]);
      ASSERT_EQ(reader.code_again(decoder, false), i % 5 == 0);
    }
    EXPECT_TRUE(decoder.used_up());
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, VoxelModelLaw, testing::Range(1U, 5U));

}  // namespace
}  // namespace liloc::codec
