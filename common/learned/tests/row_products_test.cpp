#include "common/learned/row_products.hpp"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "common/learned/tensor.hpp"

namespace liloc::learned {
namespace {

/// Of all counts of pairs up to two tiles and more, depths and panels.
TEST(RowProducts, AreWhatLoopsGive) {
  std::mt19937_64 rng(7);
  std::normal_distribution<float> normal;
  for (std::size_t count = 0; count < 15; ++count)
    for (const std::size_t depth : {1, 3, 16, 40})
      for (const std::size_t panels : {1, 3}) {
        const std::size_t rows = 20, in_stride = depth + 5, out_stride = panels * kPanel;
        std::vector<float> input(rows * in_stride), matrix(panels * depth * kPanel), output(rows * out_stride);
        for (auto* values : {&input, &matrix, &output})
          for (float& v : *values) v = normal(rng);
        std::vector<KernelMap::Pair> pairs;
        for (std::uint32_t i = 0; i < count; ++i)
          pairs.push_back({static_cast<std::uint32_t>(rng() % rows), i + i / 5});
        std::vector<double> expected(output.begin(), output.end());
        for (const auto& [in, out] : pairs)
          for (std::size_t c = 0; c < out_stride; ++c)
            for (std::size_t d = 0; d < depth; ++d)
              expected[out * out_stride + c] +=
                  static_cast<double>(input[in * in_stride + d]) *
                  static_cast<double>(matrix[(c / kPanel * depth + d) * kPanel + c % kPanel]);
        add_row_products(pairs.data(), count, input.data(), in_stride, matrix.data(), depth, panels,
                         output.data(), out_stride);
        for (std::size_t i = 0; i < output.size(); ++i)
          ASSERT_NEAR(static_cast<double>(output[i]), expected[i], 2e-5) << count << " pairs, depth " << depth;
      }
}

TEST(RowProducts, PeakIsOfAProcessorOfThisCentury) {
  const double flops = peak_flops_per_s();
  EXPECT_GT(flops, 1e7);
  EXPECT_LT(flops, 1e13);
}

}  // namespace
}  // namespace liloc::learned
