#pragma once
// Voxels and weights by seed, for tests.
#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "common/learned/voxel_set.hpp"
#include "common/learned/weights_file.hpp"

namespace liloc::learned {

/// So many voxels of -side..side - 1, some of them twice; two in three lie on three planes, as in a room.
inline std::vector<Eigen::Vector3i> random_voxels(std::uint64_t seed, int side, std::size_t count) {
  std::mt19937_64 rng(seed);
  std::uniform_int_distribution<int> any(-side, side - 1);
  std::vector<Eigen::Vector3i> voxels;
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3i v(any(rng), any(rng), any(rng));
    if (i % 3 != 0) v[static_cast<Eigen::Index>(rng() % 3)] = -side / 2;
    voxels.push_back(v);
  }
  return voxels;
}

/// Weights of a network: the channels of each level on the way down and up, as FCGF names them.
class RandomWeights {
 public:
  struct Shape {
    std::vector<std::size_t> down = {4, 8, 8}, up = {4, 4, 8};
    std::size_t first_width = 5, dimensions = 6;
  };
  /// The network of the paper.
  static Shape paper() { return {{32, 64, 128, 256}, {64, 64, 64, 128}, 7, 32}; }

  static WeightsFile of(std::uint64_t seed, const Shape& shape) {
    RandomWeights weights(seed);
    weights.fill(shape);
    return weights.file_;
  }

 private:
  explicit RandomWeights(std::uint64_t seed) : rng_(seed) {}

  void add(const std::string& name, std::vector<std::size_t> shape, float deviation, float mean = 0) {
    std::size_t count = 1;
    for (const std::size_t n : shape) count *= n;
    std::normal_distribution<float> normal(mean, deviation);
    WeightsFile::Array array{std::move(shape), {}};
    for (std::size_t i = 0; i < count; ++i) array.values.push_back(normal(rng_));
    file_.arrays[name] = std::move(array);
  }
  void add_kernel(const std::string& layer, std::size_t volume, std::size_t in, std::size_t out) {
    const float deviation = 1.0F / std::sqrt(static_cast<float>(std::min<std::size_t>(volume, 8) * in));
    if (volume == 1)
      add(layer + ".kernel", {in, out}, deviation);
    else
      add(layer + ".kernel", {volume, in, out}, deviation);
  }
  void add_norm(const std::string& norm, std::size_t channels) {
    add(norm + ".bn.weight", {channels}, 0.2F, 1);
    add(norm + ".bn.bias", {channels}, 0.2F);
    add(norm + ".bn.running_mean", {channels}, 0.2F);
    add(norm + ".bn.running_var", {channels}, 0.1F, 1);
    for (float& v : file_.arrays[norm + ".bn.running_var"].values) v = std::abs(v);
  }
  void add_block(const std::string& block, std::size_t channels) {
    for (const std::string i : {"1", "2"}) {
      add_kernel(block + ".conv" + i, 27, channels, channels);
      add_norm(block + ".norm" + i, channels);
    }
  }
  void fill(const Shape& shape) {
    const std::size_t first = shape.first_width * shape.first_width * shape.first_width;
    std::size_t in = 1;
    for (std::size_t i = 0; i < shape.down.size(); ++i) {
      const std::string number = std::to_string(i + 1);
      add_kernel("conv" + number, i == 0 ? first : 27, in, shape.down[i]);
      add_norm("norm" + number, shape.down[i]);
      add_block("block" + number, shape.down[i]);
      in = shape.down[i];
    }
    for (std::size_t i = shape.down.size() - 1; i > 0; --i) {
      const std::string number = std::to_string(i + 1);
      add_kernel("conv" + number + "_tr", 27, in, shape.up[i]);
      add_norm("norm" + number + "_tr", shape.up[i]);
      add_block("block" + number + "_tr", shape.up[i]);
      in = shape.up[i] + shape.down[i - 1];
    }
    add_kernel("conv1_tr", 1, in, shape.up[0]);
    add_kernel("final", 1, shape.up[0], shape.dimensions);
    add("final.bias", {1, shape.dimensions}, 0.1F);
    file_.about["voxel_size_m"] = "0.025";
  }

  std::mt19937_64 rng_;
  WeightsFile file_;
};

}  // namespace liloc::learned
