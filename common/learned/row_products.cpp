#include "common/learned/row_products.hpp"

#include <algorithm>
#include <cstring>
#include <ctime>
#include <iterator>

#include "common/learned/tensor.hpp"

// As common/registration/points/simd.hpp, with AVX-512 and fused multiplication: features of a network need not
// be the same to the last bit on every processor.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(LILOC_SANITIZED)
#define LILOC_FUSED __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define LILOC_FUSED
#endif

namespace liloc::learned {
namespace {

using Lanes = float __attribute__((vector_size(kPanel * sizeof(float))));
constexpr std::size_t kTileRows = 6;  // with as many sums AVX2's registers are full
constexpr std::size_t kSums = 12;     // of the loop that measures the peak: more than two units' latencies

/// Of `kRows` pairs, one panel.
template <std::size_t kRows>
[[gnu::always_inline]] inline void add_tile(const KernelMap::Pair* pairs, const float* input,
                                            std::size_t input_stride, const float* panel, std::size_t depth,
                                            float* output, std::size_t output_stride) {
  const float* in[kRows];
  Lanes sum[kRows] = {};
  for (std::size_t r = 0; r < kRows; ++r) in[r] = input + pairs[r].input * input_stride;
  for (std::size_t d = 0; d < depth; ++d) {
    Lanes row;
    std::memcpy(&row, panel + d * kPanel, sizeof row);
    for (std::size_t r = 0; r < kRows; ++r) sum[r] += in[r][d] * row;
  }
  for (std::size_t r = 0; r < kRows; ++r) {
    float* out = output + pairs[r].output * output_stride;
    Lanes row;
    std::memcpy(&row, out, sizeof row);
    row += sum[r];
    std::memcpy(out, &row, sizeof row);
  }
}

LILOC_FUSED void spin(std::size_t rounds, const float* factors, float* result) {
  Lanes sum[kSums], x, y;
  std::memcpy(&x, factors, sizeof x);
  std::memcpy(&y, factors + kPanel, sizeof y);
  std::memcpy(&sum, factors + 2 * kPanel, sizeof sum);  // all different, or the compiler makes one of them
  for (std::size_t i = 0; i < rounds; ++i)
    for (Lanes& s : sum) s = s * x + y;
  for (const Lanes& s : sum)
    for (int lane = 0; lane < kPanel; ++lane) *result += s[lane];
}

}  // namespace

LILOC_FUSED void add_row_products(const KernelMap::Pair* pairs, std::size_t count, const float* input,
                                  std::size_t input_stride, const float* matrix, std::size_t depth,
                                  std::size_t panels, float* output, std::size_t output_stride) {
  for (std::size_t p = 0; p < panels; ++p) {
    const float* panel = matrix + p * depth * kPanel;
    float* out = output + p * kPanel;
    std::size_t i = 0;
    for (; i + kTileRows <= count; i += kTileRows)
      add_tile<kTileRows>(pairs + i, input, input_stride, panel, depth, out, output_stride);
    if (i + 3 <= count) {
      add_tile<3>(pairs + i, input, input_stride, panel, depth, out, output_stride);
      i += 3;
    }
    for (; i < count; ++i) add_tile<1>(pairs + i, input, input_stride, panel, depth, out, output_stride);
  }
}

double peak_flops_per_s() {
  constexpr std::size_t kRounds = 1'000'000, kRepeats = 5;
  float factors[(2 + kSums) * kPanel], result = 0;
  for (std::size_t i = 0; i < std::size(factors); ++i) factors[i] = 0.5F + 0.001F * static_cast<float>(i);
  double best_s = 1e9;
  for (std::size_t i = 0; i < kRepeats; ++i) {
    const std::clock_t began = std::clock();
    spin(kRounds, factors, &result);
    const double took_s = static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
    if (result != 0) best_s = std::min(best_s, took_s);
  }
  return 2.0 * kSums * kPanel * kRounds / best_s;
}

}  // namespace liloc::learned
