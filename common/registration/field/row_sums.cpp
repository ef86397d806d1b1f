#include "common/registration/field/row_sums.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <limits>

#include "common/registration/points/simd.hpp"

namespace liloc {
namespace {

constexpr int kBlock = RowSums::kBlock;
constexpr std::size_t kGroup = 8;  // rows that add up in a byte
constexpr std::int16_t kBelow = std::numeric_limits<std::int16_t>::min();

using Bytes = std::int8_t __attribute__((vector_size(kBlock)));
using Words = std::int16_t __attribute__((vector_size(2 * kBlock)));

/// sums[i] = row(0)[i] + row(1)[i] + ... for a block.
template <class Row>
[[gnu::always_inline]] inline void sum_block(const Row& row, std::size_t count, Words* sums) {
  Words total{};
  std::size_t k = 0;
  for (; k + kGroup <= count; k += kGroup) {
    Bytes group{};
    for (std::size_t i = 0; i < kGroup; ++i) {
      Bytes more;
      std::memcpy(&more, row(k + i), sizeof more);
      group += more;
    }
    total += __builtin_convertvector(group, Words);
  }
  for (; k < count; ++k) {
    Bytes more;
    std::memcpy(&more, row(k), sizeof more);
    total += __builtin_convertvector(more, Words);
  }
  *sums = total;
}

/// The same places of all columns added.
LILOC_WIDEST void sum_columns(const std::int8_t* const* columns, std::ptrdiff_t shift, std::size_t count,
                              int height, std::int16_t* sums) {
  for (int y = 0; y < height; y += kBlock) {
    Words total;
    sum_block([&](std::size_t k) { return columns[k] + shift + y; }, count, &total);
    std::memcpy(sums + y, &total, sizeof total);
  }
}

/// A block of a row; whether any place of it exceeds the threshold.
LILOC_WIDEST bool sum_rows(const std::int8_t* cells, const std::ptrdiff_t* rows, std::size_t count,
                           std::int16_t threshold, std::int16_t* sums) {
  Words total;
  sum_block([&](std::size_t k) { return cells + rows[k]; }, count, &total);
  std::memcpy(sums, &total, sizeof total);
  const Words exceeds = total > threshold;
  std::uint64_t any[sizeof exceeds / sizeof(std::uint64_t)], some = 0;
  std::memcpy(any, &exceeds, sizeof exceeds);
  for (const std::uint64_t part : any) some |= part;
  return some != 0;
}

}  // namespace

RowSums::RowSums(const ScoreField& field, const BlockMaxima& maxima)
    : field_(field),
      maxima_(maxima),
      width_((field.size().x() + 31) / 32 * 32),
      height_(field.size().y()),
      height_padded_((height_ + kBlock - 1) / kBlock * kBlock),
      bounds_(static_cast<std::size_t>(width_ / kBlock * height_padded_)),
      sums_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}

void RowSums::take(std::vector<CellOffset> offsets) {
  offsets_ = std::move(offsets);
  std::erase_if(offsets_, [&](const CellOffset& o) { return std::abs(o.x) > field_.pad(); });
  std::ranges::stable_sort(offsets_, {}, &CellOffset::y);
}

/// The rows and columns of the offsets that are inside at one height.
void RowSums::select(int z) {
  const std::int8_t* cells = field_.row(0, 0, 0);
  const std::ptrdiff_t stride = field_.stride();
  rows_.clear();
  rows_y_.clear();
  columns_.clear();
  beyond_ = 0;
  for (const CellOffset& o : offsets_) {
    if (z + o.z < 0 || z + o.z >= field_.size().z()) continue;
    rows_.push_back(field_.row(0, z + o.z, o.plane) - cells + o.y * stride + o.x);
    rows_y_.push_back(o.y);
    if (std::abs(o.y) <= BlockMaxima::kPad)
      columns_.push_back(maxima_.column(o.x, z + o.z, o.plane) + o.y);
    else
      beyond_ += ScoreField::kSurface;
  }
}

/// What no place of a block exceeds.
void RowSums::bound() {
  for (int b = 0; b < width_ / kBlock; ++b)
    sum_columns(columns_.data(),
                static_cast<std::ptrdiff_t>(b) * (kBlock / BlockMaxima::kStep) * maxima_.stride(),
                columns_.size(), height_padded_, &bounds_[static_cast<std::size_t>(b * height_padded_)]);
}

/// The blocks of a row that may exceed the threshold, from the offsets first .. last - 1.
void RowSums::sum_row(int y, std::size_t first, std::size_t last, int threshold,
                      std::vector<std::uint32_t>* above) {
  const std::int8_t* cells = field_.row(y, 0, 0);
  for (int b = 0; b < width_ / kBlock; ++b) {
    if (bounds_[static_cast<std::size_t>(b * height_padded_ + y)] + beyond_ <= threshold) continue;
    const auto begin = static_cast<std::size_t>(y * width_ + b * kBlock);
    if (!sum_rows(cells + b * kBlock, rows_.data() + first, last - first, static_cast<std::int16_t>(threshold),
                  &sums_[begin]))
      continue;
    for (std::size_t i = begin; i < begin + kBlock; ++i)
      if (sums_[i] > threshold) above->push_back(static_cast<std::uint32_t>(i));
  }
}

const std::vector<std::int16_t>& RowSums::at_height(int z, int threshold, std::vector<std::uint32_t>* above) {
  select(z);
  bound();
  std::ranges::fill(sums_, kBelow);
  above->clear();
  std::size_t first = rows_y_.size(), last = first;  // of the offsets that are inside at one y
  for (int y = 0; y < height_; ++y) {
    while (first > 0 && rows_y_[first - 1] >= -y) --first;
    while (last > 0 && rows_y_[last - 1] >= height_ - y) --last;
    sum_row(y, first, last, threshold, above);
  }
  return sums_;
}

}  // namespace liloc
