#include "common/registration/row_sums.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>

#include "common/registration/simd.hpp"

namespace liloc {
namespace {

constexpr int kBlock = 32;         // places at once
constexpr std::size_t kGroup = 8;  // rows that add up in a byte

struct One {  // block at a time
  using Bytes = std::int8_t __attribute__((vector_size(kBlock)));
  using Words = std::int16_t __attribute__((vector_size(2 * kBlock)));
};
struct Two {  // blocks at a time
  using Bytes = std::int8_t __attribute__((vector_size(2 * kBlock)));
  using Words = std::int16_t __attribute__((vector_size(4 * kBlock)));
};

/// Adds the same places of all rows.
template <class Blocks>
[[gnu::always_inline]] inline void sum_block(const std::int8_t* cells, const std::ptrdiff_t* rows,
                                             std::size_t count, std::int16_t* sums) {
  using Bytes = typename Blocks::Bytes;
  using Words = typename Blocks::Words;
  Words total{};
  const auto add = [&](std::size_t k, Bytes* bytes) {
    Bytes row;
    std::memcpy(&row, cells + rows[k], sizeof row);
    *bytes += row;
  };
  std::size_t k = 0;
  for (; k + kGroup <= count; k += kGroup) {
    Bytes bytes{};
    for (std::size_t i = 0; i < kGroup; ++i) add(k + i, &bytes);
    total += __builtin_convertvector(bytes, Words);
  }
  Bytes bytes{};
  for (; k < count; ++k) add(k, &bytes);
  total += __builtin_convertvector(bytes, Words);
  std::memcpy(sums, &total, sizeof total);
}

/// sums[i] = cells[rows[0] + i] + cells[rows[1] + i] + ... over a whole row.
LILOC_WIDEST void sum_rows(const std::int8_t* cells, const std::ptrdiff_t* rows, std::size_t count, int width,
                           std::int16_t* sums) {
  int x = 0;
  for (; x + 2 * kBlock <= width; x += 2 * kBlock) sum_block<Two>(cells + x, rows, count, sums + x);
  if (x < width) sum_block<One>(cells + x, rows, count, sums + x);
}

/// Which blocks hold a value above the threshold; `found` has room for all. Returns how many do.
LILOC_WIDEST std::size_t blocks_above(const std::int16_t* values, std::size_t blocks, std::int16_t threshold,
                                      std::uint32_t* found) {
  std::size_t count = 0;
  for (std::size_t b = 0; b < blocks; ++b) {
    std::int16_t most = values[b * kBlock];
    for (std::size_t i = 1; i < kBlock; ++i) most = std::max(most, values[b * kBlock + i]);
    found[count] = static_cast<std::uint32_t>(b);
    count += most > threshold ? 1 : 0;
  }
  return count;
}

}  // namespace

RowSums::RowSums(const ScoreField& field)
    : field_(field),
      width_((field.size().x() + kBlock - 1) / kBlock * kBlock),
      height_(field.size().y()),
      sums_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_)) {}

void RowSums::take(std::vector<CellOffset> offsets) {
  offsets_ = std::move(offsets);
  std::erase_if(offsets_, [&](const CellOffset& o) { return std::abs(o.x) > field_.pad(); });
  std::ranges::stable_sort(offsets_, {}, &CellOffset::y);
}

const std::vector<std::int16_t>& RowSums::at_height(int z) {
  const std::int8_t* cells = field_.row(0, 0, 0);
  const std::ptrdiff_t stride = field_.stride();
  rows_.clear();
  rows_y_.clear();
  for (const CellOffset& o : offsets_) {
    if (z + o.z < 0 || z + o.z >= field_.size().z()) continue;
    rows_.push_back(field_.row(0, z + o.z, o.plane) - cells + o.y * stride + o.x);
    rows_y_.push_back(o.y);
  }
  for (int y = 0; y < height_; ++y) {
    const auto first = std::ranges::lower_bound(rows_y_, -y) - rows_y_.begin();
    const auto last = std::ranges::lower_bound(rows_y_, height_ - y) - rows_y_.begin();
    sum_rows(cells + y * stride, rows_.data() + first, static_cast<std::size_t>(last - first), width_,
             sums_.data() + static_cast<std::ptrdiff_t>(y) * width_);
  }
  return sums_;
}

void find_above(const std::vector<std::int16_t>& sums, int threshold, std::vector<std::uint32_t>* found) {
  const std::size_t blocks = sums.size() / kBlock;
  std::vector<std::uint32_t> above(blocks);
  above.resize(blocks_above(sums.data(), blocks, static_cast<std::int16_t>(threshold), above.data()));
  found->clear();
  for (const std::uint32_t b : above)
    for (std::uint32_t i = b * kBlock; i < (b + 1) * kBlock; ++i)
      if (sums[i] > threshold) found->push_back(i);
}

}  // namespace liloc
