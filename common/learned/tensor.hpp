#pragma once
#include <Eigen/Core>

namespace liloc::learned {

/// Columns that the product works on at once: a register of AVX-512.
inline constexpr int kPanel = 16;

[[nodiscard]] constexpr int panels_of(int channels) {
  return (channels + kPanel - 1) / kPanel;
}

/// One row of channels per voxel of a set, filled up with zeros to whole panels.
struct Tensor {
  using Rows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  Tensor() = default;
  /// Zeros.
  Tensor(std::size_t rows, int of_channels)
      : values(Rows::Zero(static_cast<Eigen::Index>(rows), panels_of(of_channels) * kPanel)),
        channels(of_channels) {}

  [[nodiscard]] std::size_t size() const { return static_cast<std::size_t>(values.rows()); }
  [[nodiscard]] std::size_t stride() const { return static_cast<std::size_t>(values.cols()); }

  Rows values;
  int channels = 0;
};

/// The channels of `a`, then those of `b`; both of the same voxels.
[[nodiscard]] inline Tensor joined(const Tensor& a, const Tensor& b) {
  Tensor result(a.size(), a.channels + b.channels);
  result.values.leftCols(a.channels) = a.values.leftCols(a.channels);
  result.values.middleCols(a.channels, b.channels) = b.values.leftCols(b.channels);
  return result;
}

}  // namespace liloc::learned
