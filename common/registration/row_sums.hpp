#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/registration/score_field.hpp"

namespace liloc {

/// A device point as an offset in cells from the device's, and the plane of the field that it is looked up in.
struct CellOffset {
  int x, y, z, plane;
};

/// What a set of device points is worth at every place (x, y) of one height of a field: sums[y * width + x] is
/// the sum over the offsets of the field's cell at (x, y, z) + offset; cells outside count 0. `width`: the
/// field's rounded up to 32. Values of the field stay within +-15, so that eight add up in a byte.
class RowSums {
 public:
  explicit RowSums(const ScoreField& field);
  /// The device points from now on. Those whose |x| exceeds the field's padding are left out.
  void take(std::vector<CellOffset> offsets);
  [[nodiscard]] const std::vector<std::int16_t>& at_height(int z);
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

 private:
  const ScoreField& field_;
  int width_, height_;
  std::vector<CellOffset> offsets_;   ///< by rising y: those inside the field at one y are neighbours
  std::vector<int> rows_y_;           ///< of the offsets inside at one z ...
  std::vector<std::ptrdiff_t> rows_;  ///< ... and where their rows start for y = 0, from the field's first cell
  std::vector<std::int16_t> sums_;
};

/// Indices of the sums above `threshold`, rising.
void find_above(const std::vector<std::int16_t>& sums, int threshold, std::vector<std::uint32_t>* found);

}  // namespace liloc
