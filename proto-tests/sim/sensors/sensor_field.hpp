#pragma once
// Randomness that is alike in neighbouring pixels: what a filter or a matching window leaves of a pixel's own.
#include <cmath>
#include <cstdint>

#include "proto-tests/sim/base/random.hpp"

namespace liloc::sim {

/// A normal number (mean 0, standard deviation 1) per pixel, interpolated between the knots of a grid. Those of
/// pixels more than two steps apart are independent.
class SensorField {
 public:
  /// `key` decides all numbers; `step_px` is the distance of the knots, at least 1.
  SensorField(std::uint64_t key, double step_px) : key_(key), step_px_(std::max(1.0, step_px)) {}

  [[nodiscard]] float at(int u, int v) const {
    const double x = u / step_px_, y = v / step_px_;
    const double fx = x - std::floor(x), fy = y - std::floor(y);
    const auto column = static_cast<std::uint64_t>(x), row = static_cast<std::uint64_t>(y);
    const double w[] = {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy};
    double sum = 0, square = 0;
    for (std::uint64_t corner = 0; corner < 4; ++corner) {
      sum += w[corner] * knot(column + (corner & 1), row + (corner >> 1));
      square += w[corner] * w[corner];
    }
    return static_cast<float>(sum / std::sqrt(square));
  }

 private:
  [[nodiscard]] double knot(std::uint64_t column, std::uint64_t row) const {
    const std::uint64_t bits = mix(key_ ^ mix(column + (row << 20)));
    double sum = -131070.0;
    for (int shift = 0; shift < 64; shift += 16) sum += static_cast<double>((bits >> shift) & 0xFFFF);
    return sum / 37837.0;  // of four even numbers: standard deviation 37837
  }

  std::uint64_t key_;
  double step_px_;
};

/// The share of normal numbers below `x`: turns a field's number into an even one, 0..1.
[[nodiscard]] inline float share_below(float x) {
  return 0.5F * std::erfc(-x * 0.70710678F);
}

/// 1 / (1 + exp(-x)).
[[nodiscard]] inline float logistic(float x) {
  return 1 / (1 + std::exp(-x));
}

}  // namespace liloc::sim
