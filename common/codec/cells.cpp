#include "common/codec/cells.hpp"

namespace liloc::codec {
namespace {

// All but x; all but x and y.
constexpr CellId kRow = ~((CellId{1} << kCellBits) - 1), kSlice = ~((CellId{1} << (2 * kCellBits)) - 1);

/// Where the run of cells ends that agree with the first in the bits of `part`.
std::size_t run_end(const std::vector<CellId>& cells, std::size_t begin, CellId part) {
  std::size_t end = begin;
  while (end < cells.size() && (cells[end] & part) == (cells[begin] & part)) ++end;
  return end;
}

}  // namespace

// A slice of parents gives two slices of children, a row in it two rows in each of these.
std::vector<CellId> children_of(const std::vector<CellId>& cells, const std::vector<std::uint8_t>& masks) {
  std::vector<CellId> children;
  children.reserve(cells.size() * 4);
  for (std::size_t slice = 0; slice < cells.size();) {
    const std::size_t slice_end = run_end(cells, slice, kSlice);
    for (unsigned z = 0; z < 2; ++z)
      for (std::size_t row = slice; row < slice_end;) {
        const std::size_t row_end = run_end(cells, row, kRow);
        for (unsigned y = 0; y < 2; ++y)
          for (std::size_t i = row; i < row_end; ++i)
            for (unsigned x = 0; x < 2; ++x)
              if (masks[i] >> (x | y << 1 | z << 2) & 1)
                children.push_back(cell_id(2 * coordinate(cells[i], 0) + x, 2 * coordinate(cells[i], 1) + y,
                                           2 * coordinate(cells[i], 2) + z));
        row = row_end;
      }
    slice = slice_end;
  }
  return children;
}

}  // namespace liloc::codec
