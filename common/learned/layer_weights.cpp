#include "common/learned/layer_weights.hpp"

#include <algorithm>

namespace liloc::learned {
namespace {

constexpr std::size_t kMostChannels = 4096;  // by hand: the paper's network has 256

/// The odd width whose cube is `volume`, up to the widest that can be mapped; 0: none.
int width_of(std::size_t volume) {
  for (int width = 1; width <= 2 * VoxelNeighbors::kMostRadius + 1; width += 2)
    if (static_cast<std::size_t>(width * width * width) == volume) return width;
  return 0;
}

}  // namespace

Result<std::vector<float>> LayerWeights::vector(const std::string& name, int size) const {
  const auto found = file_.arrays.find(name);
  if (found == file_.arrays.end()) return fail("{} is missing", name);
  if (found->second.values.size() != static_cast<std::size_t>(size))
    return fail("{} has {} values, not {}", name, found->second.values.size(), size);
  return found->second.values;
}

Result<ConvolutionWeights> LayerWeights::kernel(const std::string& layer) const {
  const auto found = file_.arrays.find(layer + ".kernel");
  if (found == file_.arrays.end()) return fail("{}.kernel is missing", layer);
  std::vector<std::size_t> shape = found->second.shape;
  if (shape.size() == 2) shape.insert(shape.begin(), 1);
  if (shape.size() != 3 || width_of(shape[0]) == 0 || shape[1] > kMostChannels || shape[2] > kMostChannels)
    return fail("{}.kernel has {} axes, or sizes that no layer has; offsets are 1, 27, 125 or 343", layer,
                found->second.shape.size());
  ConvolutionWeights weights{width_of(shape[0]), static_cast<int>(shape[1]), static_cast<int>(shape[2]),
                             found->second.values, std::vector<float>(shape[2], 0.0F)};
  if (!file_.arrays.contains(layer + ".bias")) return weights;
  auto bias = vector(layer + ".bias", weights.outputs);
  if (!bias) return tl::unexpected(bias.error());
  weights.bias = std::move(*bias);
  return weights;
}

Result<BatchNorm> LayerWeights::batch_norm(const std::string& norm, int channels) const {
  BatchNorm result;
  for (const auto& [name, values] :
       {std::pair{"running_mean", &result.mean}, std::pair{"running_var", &result.variance},
        std::pair{"weight", &result.scale}, std::pair{"bias", &result.shift}}) {
    auto found = vector(fmt::format("{}.bn.{}", norm, name), channels);
    if (!found) return tl::unexpected(found.error());
    *values = std::move(*found);
  }
  if (std::ranges::any_of(result.variance, [](float v) { return v < 0; }))
    return fail("{}.bn.running_var has a negative value", norm);
  return result;
}

Result<ConvolutionWeights> LayerWeights::convolution(const std::string& layer, const std::string& norm,
                                                     int inputs, int width) const {
  auto weights = kernel(layer);
  if (!weights) return weights;
  if (inputs != 0 && weights->inputs != inputs)
    return fail("{}.kernel takes {} channels; what comes before it gives {}", layer, weights->inputs, inputs);
  if (width != 0 && weights->width != width)
    return fail("{}.kernel is {} wide, not {}", layer, weights->width, width);
  if (norm.empty()) return weights;
  const auto batch = batch_norm(norm, weights->outputs);
  if (!batch) return tl::unexpected(batch.error());
  return folded(std::move(*weights), *batch);
}

}  // namespace liloc::learned
