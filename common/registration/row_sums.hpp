#pragma once
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
  /// Offsets whose |x| exceeds the field's padding are left out.
  const std::vector<std::int16_t>& at_height(const std::vector<CellOffset>& offsets, int z);
  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int height() const { return height_; }

 private:
  const ScoreField& field_;
  int width_, height_;
  std::vector<std::int8_t> zeros_;
  std::vector<std::int16_t> sums_;
  std::vector<const std::int8_t*> rows_;
};

}  // namespace liloc
