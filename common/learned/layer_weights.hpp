#pragma once
#include <string>

#include "common/learned/convolution.hpp"
#include "common/learned/weights_file.hpp"

namespace liloc::learned {

/// The layers of a network, taken out of a file by the names that PyTorch gives them.
class LayerWeights {
 public:
  /// `file` outlives this.
  explicit LayerWeights(const WeightsFile& file) : file_(file) {}

  [[nodiscard]] bool has(const std::string& layer) const { return file_.arrays.contains(layer + ".kernel"); }

  /// LAYER.kernel ([offsets, inputs, outputs], or [inputs, outputs] of one offset), with LAYER.bias where there
  /// is one, and the batch normalization NORM.bn of PyTorch folded in, unless `norm` is empty. `inputs` 0: any.
  /// Errors name the array and what it should be.
  [[nodiscard]] Result<ConvolutionWeights> convolution(const std::string& layer, const std::string& norm,
                                                       int inputs, int width = 0) const;

 private:
  [[nodiscard]] Result<std::vector<float>> vector(const std::string& name, int size) const;
  [[nodiscard]] Result<ConvolutionWeights> kernel(const std::string& layer) const;
  [[nodiscard]] Result<BatchNorm> batch_norm(const std::string& norm, int channels) const;

  const WeightsFile& file_;
};

}  // namespace liloc::learned
