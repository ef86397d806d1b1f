#pragma once
// Convolutions as text books have them, over a dense grid in double precision: slow, and the word on what the
// sparse ones should give.
#include <algorithm>
#include <cmath>
#include <vector>

#include "common/learned/convolution.hpp"
#include "common/learned/voxel_set.hpp"

namespace liloc::learned {

/// Channels at every voxel of a box; 0 outside of it.
struct DenseGrid {
  Eigen::Vector3i low = Eigen::Vector3i::Zero(), size = Eigen::Vector3i::Zero();
  int channels = 0;
  std::vector<double> values = {};

  DenseGrid(const Eigen::Vector3i& from, const Eigen::Vector3i& extent, int of_channels)
      : low(from),
        size(extent),
        channels(of_channels),
        values(static_cast<std::size_t>(extent.prod() * of_channels), 0.0) {}

  [[nodiscard]] bool holds(const Eigen::Vector3i& v) const {
    return ((v - low).array() >= 0).all() && ((v - low).array() < size.array()).all();
  }
  [[nodiscard]] double* at(const Eigen::Vector3i& v) {
    const Eigen::Vector3i d = v - low;
    return values.data() +
           static_cast<std::ptrdiff_t>(d.x() + size.x() * (d.y() + size.y() * d.z())) * channels;
  }
  template <class Visit>
  void for_each_voxel(const Visit& visit) const {
    for (int z = 0; z < size.z(); ++z)
      for (int y = 0; y < size.y(); ++y)
        for (int x = 0; x < size.x(); ++x) visit(Eigen::Vector3i(low + Eigen::Vector3i(x, y, z)));
  }
};

/// Adds a voxel's channels times the kernel's matrix `offset`.
inline void add_product(const ConvolutionWeights& w, std::size_t offset, const double* in, double* out) {
  const auto inputs = static_cast<std::size_t>(w.inputs), outputs = static_cast<std::size_t>(w.outputs);
  for (std::size_t i = 0; i < inputs; ++i)
    for (std::size_t o = 0; in[i] != 0 && o < outputs; ++o)
      out[o] += in[i] * static_cast<double>(w.matrices[(offset * inputs + i) * outputs + o]);
}

enum class Stride { one, two, two_transposed };

/// output(p) = bias + sum over offsets of input(stride p + offset) W(offset); transposed, what an input gives
/// goes to output(2 p + offset).
inline DenseGrid dense_convolution(DenseGrid input, const ConvolutionWeights& w, Stride stride) {
  const auto scaled = [&](const Eigen::Vector3i& v, bool up) -> Eigen::Vector3i {
    if (stride == Stride::one) return v;
    return up ? Eigen::Vector3i(2 * v) : Eigen::Vector3i(v.array() / 2);
  };
  const bool up = stride == Stride::two_transposed;
  // Boxes have even corners on every level, so that halving them is exact.
  DenseGrid output(scaled(input.low, up), scaled(input.size, up), w.outputs);
  output.for_each_voxel([&](const Eigen::Vector3i& v) {
    for (int c = 0; c < w.outputs; ++c) output.at(v)[c] = w.bias[static_cast<std::size_t>(c)];
  });
  const int reach = w.width / 2;
  const DenseGrid& of_pairs = up ? input : output;
  of_pairs.for_each_voxel([&](const Eigen::Vector3i& v) {
    std::size_t offset = 0;
    for (int z = -reach; z <= reach; ++z)
      for (int y = -reach; y <= reach; ++y)
        for (int x = -reach; x <= reach; ++x, ++offset) {
          const Eigen::Vector3i other =
              (stride == Stride::one ? v : Eigen::Vector3i(2 * v)) + Eigen::Vector3i(x, y, z);
          DenseGrid& there = up ? output : input;
          if (!there.holds(other)) continue;
          add_product(w, offset, input.at(up ? v : other), output.at(up ? other : v));
        }
  });
  return output;
}

/// 0 where the set has no voxel.
inline DenseGrid masked(DenseGrid grid, const VoxelSet& set) {
  grid.for_each_voxel([&](const Eigen::Vector3i& v) {
    if (set.find(v) < 0) std::fill_n(grid.at(v), grid.channels, 0.0);
  });
  return grid;
}

inline DenseGrid dense_of(const Tensor& tensor, const VoxelSet& set, const Eigen::Vector3i& low,
                          const Eigen::Vector3i& size) {
  DenseGrid grid(low, size, tensor.channels);
  for (std::size_t row = 0; row < set.size(); ++row)
    for (int c = 0; c < tensor.channels; ++c)
      grid.at(set.voxel(row))[c] = static_cast<double>(tensor.values(static_cast<Eigen::Index>(row), c));
  return grid;
}

/// The largest difference, over the voxels of the set.
inline double difference(const Tensor& tensor, const VoxelSet& set, DenseGrid grid) {
  double most = 0;
  for (std::size_t row = 0; row < set.size(); ++row)
    for (int c = 0; c < tensor.channels; ++c)
      most = std::max(most, std::abs(static_cast<double>(tensor.values(static_cast<Eigen::Index>(row), c)) -
                                     grid.at(set.voxel(row))[c]));
  return most;
}

}  // namespace liloc::learned
