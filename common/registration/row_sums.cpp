#include "common/registration/row_sums.hpp"

#include <cstdlib>
#include <cstring>

#include "common/registration/simd.hpp"

namespace liloc {
namespace {

constexpr int kBlock = 32;         // places at once
constexpr std::size_t kGroup = 8;  // rows that add up in a byte

using Bytes = std::int8_t __attribute__((vector_size(kBlock)));
using Words = std::int16_t __attribute__((vector_size(2 * kBlock)));

/// sums[i] = rows[0][i] + rows[1][i] + ... over a whole row; the number of rows is a multiple of kGroup.
LILOC_WIDE void sum_rows(const std::int8_t* const* rows, std::size_t count, int width, std::int16_t* sums) {
  for (int x = 0; x < width; x += kBlock) {
    Words total{};
    for (std::size_t k = 0; k < count; k += kGroup) {
      Bytes bytes{};
      for (std::size_t i = 0; i < kGroup; ++i) {
        Bytes row;
        std::memcpy(&row, rows[k + i] + x, sizeof row);
        bytes += row;
      }
      total += __builtin_convertvector(bytes, Words);
    }
    std::memcpy(sums + x, &total, sizeof total);
  }
}

}  // namespace

RowSums::RowSums(const ScoreField& field)
    : field_(field),
      width_((field.size().x() + kBlock - 1) / kBlock * kBlock),
      height_(field.size().y()),
      zeros_(static_cast<std::size_t>(width_ + 2 * field.pad()), 0),
      sums_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}

const std::vector<std::int16_t>& RowSums::at_height(const std::vector<CellOffset>& offsets, int z) {
  for (int y = 0; y < height_; ++y) {
    rows_.clear();
    for (const CellOffset& o : offsets) {
      const int row_z = z + o.z, row_y = y + o.y;
      if (row_z < 0 || row_z >= field_.size().z() || row_y < 0 || row_y >= height_) continue;
      if (std::abs(o.x) > field_.pad()) continue;
      rows_.push_back(field_.row(row_y, row_z, o.plane) + o.x);
    }
    while (rows_.size() % kGroup != 0) rows_.push_back(zeros_.data());
    sum_rows(rows_.data(), rows_.size(), width_, sums_.data() + static_cast<std::ptrdiff_t>(y) * width_);
  }
  return sums_;
}

}  // namespace liloc
