#pragma once
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/registration/field/score_field.hpp"

namespace liloc {

/// The greatest cell of each short stretch of a field's rows. Sums of them bound what a block of places can be
/// worth, without looking at each.
class BlockMaxima {
 public:
  // Cells from the start of a stretch to that of the next; by hand, DECISIONS.md.
  static constexpr int kStep = 4;
  static constexpr int kPad = 40;  ///< rows of zeros before and behind; devices see 8 m far, at 0.2 m

  BlockMaxima() = default;
  /// `block`: cells, a multiple of kStep.
  BlockMaxima(const ScoreField& field, int block);

  /// Of row y = 0, from which those of other rows run on: no cell x .. x + block - 1 is greater. y may run from
  /// -kPad to the field's size, rounded up to 32, + kPad.
  [[nodiscard]] const std::int8_t* column(int x, int z, int plane) const {
    return cells_.data() + index((x + pad_) / kStep, z, plane) + kPad;
  }
  [[nodiscard]] int stride() const { return stride_; }  ///< from a column to the next, kStep cells further

 private:
  void take_steps(const ScoreField& field, int z, int plane, std::int8_t* steps) const;
  [[nodiscard]] std::ptrdiff_t index(int column, int z, int plane) const {
    return ((static_cast<std::ptrdiff_t>(plane) * depth_ + z) * columns_ + column) * stride_;
  }

  int pad_ = 0, depth_ = 0, columns_ = 0, stride_ = 0;
  std::vector<std::int8_t> cells_;
};

}  // namespace liloc
