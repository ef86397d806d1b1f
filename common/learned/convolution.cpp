#include "common/learned/convolution.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "common/base/parallel.hpp"
#include "common/learned/row_products.hpp"

namespace liloc::learned {
namespace {

void finish_rows(Tensor::Rows::RowsBlockXpr rows, const Tensor::Rows* add, Eigen::Index first, bool rectify) {
  if (add != nullptr) rows += add->middleRows(first, rows.rows());
  if (rectify) rows = rows.cwiseMax(0.0F);
}

}  // namespace

ConvolutionWeights folded(ConvolutionWeights layer, const BatchNorm& norm) {
  const auto outputs = static_cast<std::size_t>(layer.outputs);
  std::vector<double> factor(outputs);
  for (std::size_t c = 0; c < outputs; ++c) {
    factor[c] = norm.scale[c] / std::sqrt(norm.variance[c] + norm.epsilon);
    layer.bias[c] =
        static_cast<float>((layer.bias[c] - norm.mean[c]) * factor[c] + static_cast<double>(norm.shift[c]));
  }
  for (std::size_t i = 0; i < layer.matrices.size(); ++i)
    layer.matrices[i] = static_cast<float>(layer.matrices[i] * factor[i % outputs]);
  return layer;
}

Convolution::Convolution(const ConvolutionWeights& weights)
    : width_(weights.width), inputs_(weights.inputs), outputs_(weights.outputs) {
  const auto volume = static_cast<std::size_t>(width_ * width_ * width_);
  const auto inputs = static_cast<std::size_t>(inputs_), outputs = static_cast<std::size_t>(outputs_);
  const auto panels = static_cast<std::size_t>(panels_of(outputs_));
  assert(weights.matrices.size() == volume * inputs * outputs && weights.bias.size() == outputs);
  matrices_.assign(volume * panels * inputs * kPanel, 0);
  for (std::size_t k = 0; k < volume; ++k)
    for (std::size_t i = 0; i < inputs; ++i)
      for (std::size_t o = 0; o < outputs; ++o)
        matrices_[((k * panels + o / kPanel) * inputs + i) * kPanel + o % kPanel] =
            weights.matrices[(k * inputs + i) * outputs + o];
  bias_ = weights.bias;
  bias_.resize(panels * kPanel, 0);
}

Tensor Convolution::operator()(const KernelMap& map, const Tensor& input, const After& after,
                               int threads) const {
  assert(input.channels == inputs_ && input.size() == map.inputs);
  Tensor output(map.outputs, outputs_);
  const auto depth = static_cast<std::size_t>(inputs_), panels = static_cast<std::size_t>(panels_of(outputs_));
  const Eigen::Map<const Eigen::RowVectorXf> bias(bias_.data(), static_cast<Eigen::Index>(bias_.size()));
  for_each_index(map.blocks(), threads, [&](std::size_t b) {
    const auto first = static_cast<Eigen::Index>(b * KernelMap::kBlockRows);
    const auto rows = std::min<Eigen::Index>(KernelMap::kBlockRows, output.values.rows() - first);
    output.values.middleRows(first, rows).rowwise() = bias;
    for (std::size_t k = 0; k < map.volume; ++k) {
      const std::uint32_t begin = map.begins[b * map.volume + k], end = map.begins[b * map.volume + k + 1];
      add_row_products(map.pairs.data() + begin, end - begin, input.values.data(), input.stride(),
                       matrices_.data() + k * panels * depth * kPanel, depth, panels, output.values.data(),
                       output.stride());
    }
    finish_rows(output.values.middleRows(first, rows), after.add != nullptr ? &after.add->values : nullptr,
                first, after.rectify);
  });
  return output;
}

double Convolution::flops(const KernelMap& map) const {
  return 2.0 * static_cast<double>(map.pairs.size()) * inputs_ * outputs_;
}

}  // namespace liloc::learned
