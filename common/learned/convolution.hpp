#pragma once
#include <vector>

#include "common/learned/kernel_map.hpp"
#include "common/learned/tensor.hpp"

namespace liloc::learned {

/// A layer as it is trained: one matrix per offset of the kernel, and what is added.
struct ConvolutionWeights {
  int width = 1;                ///< of the kernel, odd
  int inputs = 0, outputs = 0;  ///< channels
  std::vector<float> matrices;  ///< [offset][input][output]; offsets x fastest, as KernelMap has them
  std::vector<float> bias;      ///< one per output channel
};

/// A batch normalization: y = (x - mean) / sqrt(variance + epsilon) * scale + shift, per channel.
struct BatchNorm {
  std::vector<float> mean, variance, scale, shift;
  double epsilon = 1e-5;  ///< of PyTorch and MinkowskiEngine
};
/// The same as the layer and then the normalization, in one layer.
[[nodiscard]] ConvolutionWeights folded(ConvolutionWeights layer, const BatchNorm& norm);

/// A sparse convolution of any stride, transposed or not: all of that is in the map. Immutable; any thread may
/// use it.
class Convolution {
 public:
  Convolution() = default;
  explicit Convolution(const ConvolutionWeights& weights);

  struct After {
    const Tensor* add = nullptr;  ///< of the output's shape; null: nothing
    bool rectify = false;         ///< negative values become 0, after the addition
  };
  /// `map`: of this kernel's volume; `input` has its rows and as many channels as the layer takes. The result
  /// does not depend on the number of threads.
  [[nodiscard]] Tensor operator()(const KernelMap& map, const Tensor& input, const After& after,
                                  int threads) const;
  /// Multiplies and adds of one such call, that is two per pair, input and output channel.
  [[nodiscard]] double flops(const KernelMap& map) const;

  [[nodiscard]] int width() const { return width_; }
  [[nodiscard]] int inputs() const { return inputs_; }
  [[nodiscard]] int outputs() const { return outputs_; }

 private:
  int width_ = 1, inputs_ = 0, outputs_ = 0;
  std::vector<float> matrices_;  ///< [offset][panel][input][column of the panel]
  std::vector<float> bias_;      ///< whole panels
};

}  // namespace liloc::learned
