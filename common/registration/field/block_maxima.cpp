#include "common/registration/field/block_maxima.hpp"

#include <algorithm>

#include "common/registration/points/simd.hpp"

namespace liloc {
namespace {

LILOC_WIDEST void raise(const std::int8_t* others, std::size_t count, std::int8_t* values) {
#pragma omp simd
  for (std::size_t i = 0; i < count; ++i) values[i] = values[i] > others[i] ? values[i] : others[i];
}

}  // namespace

BlockMaxima::BlockMaxima(const ScoreField& field, int block)
    : pad_(field.pad()),
      depth_(field.size().z()),
      columns_((field.stride() + 31) / kStep),
      stride_((field.size().y() + 31) / 32 * 32 + 2 * kPad) {
  if (field.empty()) return;
  cells_.assign(static_cast<std::size_t>(index(0, 0, ScoreField::kDirections)), -128);
  const int reach = block / kStep + 1;  // a stretch starts up to a step before
  std::vector<std::int8_t> steps(static_cast<std::size_t>((columns_ + reach) * stride_),
                                 0);  // greatest of each
  for (int plane = 0; plane < ScoreField::kDirections; ++plane)
    for (int z = 0; z < depth_; ++z) {
      take_steps(field, z, plane, steps.data() + kPad);
      for (int k = 0; k < columns_; ++k)
        for (int i = 0; i < reach; ++i)
          raise(steps.data() + (k + i) * stride_, static_cast<std::size_t>(stride_),
                cells_.data() + index(k, z, plane));
    }
}

/// The greatest of each kStep cells, y fastest.
void BlockMaxima::take_steps(const ScoreField& field, int z, int plane, std::int8_t* steps) const {
  for (int y = 0; y < field.size().y(); ++y) {
    const std::int8_t* row = field.row(y, z, plane) - pad_;
    std::int8_t* step = steps + y;
    for (int k = 0; k < columns_; ++k, row += kStep, step += stride_)
      *step = std::max(std::max(row[0], row[1]), std::max(row[2], row[3]));
  }
}

}  // namespace liloc
