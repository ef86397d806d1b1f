#pragma once
#include <cstddef>

#include "common/learned/kernel_map.hpp"

namespace liloc::learned {

/// output[p.output] += input[p.input] * matrix, for each of `count` pairs, whose outputs differ. Rows are read
/// where they lie and summed up in registers: nothing is gathered or scattered in between.
/// `matrix`: `depth` rows in `panels` panels of kPanel columns, one panel after the other. Strides in floats; a
/// row of the output has all panels. By fused multiplication where the processor has it.
void add_row_products(const KernelMap::Pair* pairs, std::size_t count, const float* input,
                      std::size_t input_stride, const float* matrix, std::size_t depth, std::size_t panels,
                      float* output, std::size_t output_stride);

/// Floating-point operations a second of one core that does nothing but such sums, for comparison. Takes about
/// a tenth of a second.
[[nodiscard]] double peak_flops_per_s();

}  // namespace liloc::learned
