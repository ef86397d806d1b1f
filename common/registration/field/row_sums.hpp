#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/registration/field/block_maxima.hpp"
#include "common/registration/field/score_field.hpp"

namespace liloc {

/// A device point as an offset in cells from the device's, and the plane of the field that it is looked up in.
struct CellOffset {
  int x, y, z, plane;
};

/// What a set of device points is worth at the places (x, y) of one height of a field: sums[y * width + x] is
/// the sum over the offsets of the field's cell at (x, y, z) + offset; cells outside count 0. `width`: the
/// field's rounded up to 32. Values of the field stay within +-15, so that eight add up in a byte.
class RowSums {
 public:
  static constexpr int kBlock = 16;  ///< places that are summed together; 32 and 64 prune less, DECISIONS.md

  /// `maxima` of the same field, for kBlock.
  RowSums(const ScoreField& field, const BlockMaxima& maxima);
  /// The device points from now on. Those whose |x| exceeds the field's padding are left out.
  void take(std::vector<CellOffset> offsets);
  /// What exceeds `threshold` is exact, and its indices, rising, are `above`; the rest is no more than that.
  [[nodiscard]] const std::vector<std::int16_t>& at_height(int z, int threshold,
                                                           std::vector<std::uint32_t>* above);
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

 private:
  void select(int z);
  void bound();
  void sum_row(int y, std::size_t first, std::size_t last, int threshold, std::vector<std::uint32_t>* above);

  const ScoreField& field_;
  const BlockMaxima& maxima_;
  int width_, height_;
  std::vector<CellOffset> offsets_;   ///< by rising y: those inside the field at one y are neighbours
  std::vector<int> rows_y_;           ///< of the offsets inside at one z ...
  std::vector<std::ptrdiff_t> rows_;  ///< ... and where their rows start for y = 0, from the field's first cell
  std::vector<const std::int8_t*> columns_;  ///< their maxima for the first block, but for those too far in y
  int height_padded_, beyond_ = 0;           ///< beyond_: what the latter may be worth
  std::vector<std::int16_t> bounds_;         ///< block by block, y fastest
  std::vector<std::int16_t> sums_;
};

}  // namespace liloc
