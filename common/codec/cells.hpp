#pragma once
// Private to the room: sorted lists of grid cells, and their neighbours found by walking along.
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace liloc::codec {

/// A cell as one number that sorts by z, then y, then x. Coordinates are 0..2^18; one more is kept on either
/// side, so that the number of a neighbour is the cell's plus a constant.
using CellId = std::uint64_t;
// Bits of an axis in an id, three of which fit 64; clouds are cut no finer than the depth.
constexpr int kCellBits = 20, kMaxDepth = 18;

[[nodiscard]] constexpr CellId cell_id(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  return (x + 1) | (y + 1) << kCellBits | (z + 1) << (2 * kCellBits);
}
/// 0 is x, 1 is y, 2 is z.
[[nodiscard]] constexpr std::uint64_t coordinate(CellId cell, int axis) {
  return (cell >> (axis * kCellBits) & ((CellId{1} << kCellBits) - 1)) - 1;
}
[[nodiscard]] constexpr CellId parent_of(CellId cell) {
  return cell_id(coordinate(cell, 0) >> 1, coordinate(cell, 1) >> 1, coordinate(cell, 2) >> 1);
}
/// Which of its parent's children a cell is; x in the lowest bit.
[[nodiscard]] constexpr unsigned octant_of(CellId cell) {
  return static_cast<unsigned>((coordinate(cell, 0) & 1) | (coordinate(cell, 1) & 1) << 1 |
                               (coordinate(cell, 2) & 1) << 2);
}

/// Finds the cells that lie `step` away from those of a sorted list, asked for in the list's order.
class Walker {
 public:
  Walker(const std::vector<CellId>& cells, int dx, int dy, int dz)
      : cells_(cells),
        step_(static_cast<CellId>(dx) + (static_cast<CellId>(dy) << kCellBits) +
              (static_cast<CellId>(dz) << (2 * kCellBits))) {}
  /// The cell asked for, modulo 2^64: what lies before the first cell is a large number, or one below it.
  [[nodiscard]] CellId wanted(CellId from) const { return from + step_; }
  /// Index of the first cell that does not come before the one asked for.
  std::size_t seek(CellId from) {
    const CellId target = wanted(from);
    while (at_ < cells_.size() && cells_[at_] < target) ++at_;
    return at_;
  }
  /// Index of the cell itself, or -1.
  std::ptrdiff_t find(CellId from) {
    const std::size_t at = seek(from);
    return at < cells_.size() && cells_[at] == wanted(from) ? static_cast<std::ptrdiff_t>(at) : -1;
  }

 private:
  const std::vector<CellId>& cells_;
  CellId step_;
  std::size_t at_ = 0;
};

/// The children of sorted cells, sorted. `masks`: a bit per octant.
[[nodiscard]] std::vector<CellId> children_of(const std::vector<CellId>& cells,
                                              const std::vector<std::uint8_t>& masks);

}  // namespace liloc::codec
