#pragma once
// The fully convolutional network of FCGF (Choy, Park, Koltun: ICCV 2019), of which the paper has its features.
#include <filesystem>
#include <memory>
#include <vector>

#include "common/learned/convolution.hpp"
#include "common/learned/weights_file.hpp"

namespace liloc::learned {

/// The voxels of a cloud at each level of the network, and the kernel maps between them: made once, for all
/// layers.
struct NetworkMaps {
  std::vector<VoxelSet> sets;               ///< the cloud's, and each halved from the one before
  KernelMap first, point;                   ///< of the first layer, and of those of one offset
  std::vector<KernelMap> blocks;            ///< per level, for its residual blocks
  std::vector<KernelMap> down, up;          ///< from each level to the next, and back
  [[nodiscard]] std::size_t pairs() const;  ///< of all maps
};

/// A U-net of residual blocks (ResUNetBN2 with its letters, and smaller ones): convolutions of stride 2 down,
/// as many transposed ones up, what has the same size joined, one descriptor per voxel. How many levels, which
/// channels and how wide the first kernel is, the weights say. Immutable; any thread may use it.
class FeatureNetwork {
 public:
  /// Errors name the array and what it should be.
  [[nodiscard]] static Result<FeatureNetwork> of(const WeightsFile& file);
  /// Errors name the file, and where such a file comes from.
  [[nodiscard]] static Result<std::shared_ptr<const FeatureNetwork>> load(const std::filesystem::path& file);

  [[nodiscard]] NetworkMaps maps(const VoxelSet& set, int threads) const;
  /// The descriptors of a set's voxels, row by row, of unit length where the network was trained so. The result
  /// does not depend on the number of threads.
  [[nodiscard]] Tensor operator()(const NetworkMaps& maps, int threads) const;
  /// Floating-point operations of that.
  [[nodiscard]] double flops(const NetworkMaps& maps) const;

  [[nodiscard]] int dimensions() const { return final_.outputs(); }
  [[nodiscard]] double voxel_size_m() const { return voxel_size_m_; }  ///< that it was trained at

 private:
  struct Block {
    Convolution first, second;
  };
  struct Level {
    Convolution down;  ///< of the first level: the first layer
    Block block;
    Convolution up;  ///< from the level below to this one's size; of the first level: of one offset
    Block up_block;  ///< of the first level: none
  };

  [[nodiscard]] static Result<Block> block_of(const class LayerWeights& weights, const std::string& name,
                                              int channels);
  [[nodiscard]] static Tensor run(const Block& block, const KernelMap& map, const Tensor& input, int threads);

  std::vector<Level> levels_;
  Convolution final_;
  double voxel_size_m_ = 0;
  bool normalize_ = true;
};

}  // namespace liloc::learned
