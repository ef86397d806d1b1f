#include "common/codec/cells.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace liloc::codec {
namespace {

class CellsLaw : public testing::TestWithParam<unsigned> {};

constexpr std::uint64_t kLast = (1U << kMaxDepth) - 1;  // the largest coordinate of a cell

/// Sorted, each once, some at the rim of what an id can tell.
std::vector<CellId> some_cells(std::mt19937_64& rng, std::uint64_t side) {
  std::set<CellId> cells{cell_id(0, 0, 0), cell_id(kLast, kLast, kLast), cell_id(kLast, 0, kLast)};
  for (int i = 0; i < 2000; ++i) cells.insert(cell_id(rng() % side, rng() % side, rng() % side));
  return {cells.begin(), cells.end()};
}

TEST_P(CellsLaw, IdsKeepCoordinatesAndSortByZThenYThenX) {
  std::mt19937_64 rng(GetParam());
  for (int i = 0; i < 1000; ++i) {
    const std::array<std::uint64_t, 3> a{rng() % (kLast + 1), rng() % (kLast + 1), rng() % 4},
        b{rng() % (kLast + 1), rng() % 4, rng() % 4};
    const CellId cell = cell_id(a[0], a[1], a[2]), other = cell_id(b[0], b[1], b[2]);
    for (int axis = 0; axis < 3; ++axis) ASSERT_EQ(coordinate(cell, axis), a[static_cast<std::size_t>(axis)]);
    ASSERT_EQ(cell < other, (std::array{a[2], a[1], a[0]} < std::array{b[2], b[1], b[0]}));
  }
}

TEST_P(CellsLaw, ChildrenOfParentsAreTheCellsThatTheMasksName) {
  std::mt19937_64 rng(GetParam());
  const std::vector<CellId> cells = some_cells(rng, 40);
  std::vector<CellId> parents;
  for (const CellId cell : cells) parents.push_back(parent_of(cell));
  std::ranges::sort(parents);
  parents.erase(std::ranges::unique(parents).begin(), parents.end());
  std::vector<std::uint8_t> masks(parents.size(), 0);
  for (const CellId cell : cells)
    masks[static_cast<std::size_t>(std::ranges::lower_bound(parents, parent_of(cell)) - parents.begin())] |=
        static_cast<std::uint8_t>(1U << octant_of(cell));
  EXPECT_LT(parents.size(), cells.size());
  EXPECT_EQ(children_of(parents, masks), cells);
}

TEST_P(CellsLaw, AWalkerFindsTheNeighbourOfEachCellOrNone) {
  std::mt19937_64 rng(GetParam());
  const std::vector<CellId> cells = some_cells(rng, 12);
  int found = 0;
  for (int k = 0; k < 27; ++k) {
    const int dx = k % 3 - 1, dy = k / 3 % 3 - 1, dz = k / 9 - 1;
    Walker walker(cells, dx, dy, dz);
    for (const CellId cell : cells) {
      const auto moved = [&](int axis, int by) {
        return coordinate(cell, axis) + static_cast<std::uint64_t>(by);
      };
      const auto at = std::ranges::find(cells, cell_id(moved(0, dx), moved(1, dy), moved(2, dz)));
      const std::ptrdiff_t expected = at == cells.end() ? -1 : at - cells.begin();
      ASSERT_EQ(walker.find(cell), expected) << dx << " " << dy << " " << dz;
      found += expected >= 0;
    }
  }
  EXPECT_GT(found, 1000);
}

INSTANTIATE_TEST_SUITE_P(Seeds, CellsLaw, testing::Range(1U, 4U));

}  // namespace
}  // namespace liloc::codec
