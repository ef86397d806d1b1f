#include "common/learned/convolution.hpp"

#include <gtest/gtest.h>

#include <random>

#include "common/learned/tests/dense_reference.hpp"
#include "common/learned/tests/random_network.hpp"

namespace liloc::learned {
namespace {

constexpr double kExact = 1e-5;  // of values about 1
const Eigen::Vector3i kLow(-8, -8, -8), kSize(16, 16, 16);

class ConvolutionLaw : public testing::TestWithParam<std::uint64_t> {
 protected:
  float normal() { return normal_(rng_); }

  ConvolutionWeights weights(int width, int inputs, int outputs) {
    ConvolutionWeights w{width, inputs, outputs, {}, {}};
    const float scale = 1.0F / std::sqrt(static_cast<float>(4 * width * inputs));
    for (int i = 0; i < width * width * width * inputs * outputs; ++i) w.matrices.push_back(scale * normal());
    for (int i = 0; i < outputs; ++i) w.bias.push_back(normal());
    return w;
  }
  Tensor features(const VoxelSet& set, int channels) {
    Tensor t(set.size(), channels);
    for (Eigen::Index row = 0; row < t.values.rows(); ++row)
      for (int c = 0; c < channels; ++c) t.values(row, c) = normal();
    return t;
  }

  const VoxelSet fine = *VoxelSet::of(random_voxels(GetParam(), 8, 900));
  const VoxelSet coarse = fine.halved();

 private:
  std::mt19937_64 rng_{GetParam()};
  std::normal_distribution<float> normal_;
};

TEST_P(ConvolutionLaw, OfStrideOneIsTheDenseOne) {
  for (const int width : {1, 3, 5, 7}) {
    const ConvolutionWeights w = weights(width, 3, 18);
    const Tensor input = features(fine, 3);
    const Tensor output = Convolution(w)(same_map(fine, width, 1), input, {}, 1);
    EXPECT_LT(difference(output, fine, dense_convolution(dense_of(input, fine, kLow, kSize), w, Stride::one)),
              kExact)
        << width;
    EXPECT_EQ(output.values.rightCols(14).cwiseAbs().maxCoeff(), 0.0F) << "what fills up the last panel";
  }
}

TEST_P(ConvolutionLaw, OfStrideTwoIsTheDenseOne) {
  const ConvolutionWeights w = weights(3, 5, 7);
  const Tensor input = features(fine, 5);
  const Tensor output = Convolution(w)(down_map(fine, coarse, 3, 1), input, {}, 1);
  EXPECT_LT(difference(output, coarse, dense_convolution(dense_of(input, fine, kLow, kSize), w, Stride::two)),
            kExact);
}

TEST_P(ConvolutionLaw, TransposedIsTheDenseOne) {
  const ConvolutionWeights w = weights(3, 5, 7);
  const Tensor input = features(coarse, 5);
  const Tensor output = Convolution(w)(transposed(down_map(fine, coarse, 3, 1)), input, {}, 1);
  const DenseGrid dense = dense_of(input, coarse, kLow / 2, kSize / 2);
  EXPECT_LT(difference(output, fine, dense_convolution(dense, w, Stride::two_transposed)), kExact);
}

TEST_P(ConvolutionLaw, AddsThenRectifies) {
  const ConvolutionWeights w = weights(3, 4, 4);
  const KernelMap map = same_map(fine, 3, 1);
  const Tensor input = features(fine, 4), extra = features(fine, 4);
  const Convolution layer(w);
  const Tensor bare = layer(map, input, {}, 1), both = layer(map, input, {&extra, true}, 1);
  EXPECT_TRUE(both.values.isApprox((bare.values + extra.values).cwiseMax(0.0F)));
}

TEST_P(ConvolutionLaw, ThreadsChangeNoBit) {
  const VoxelSet many = *VoxelSet::of(random_voxels(GetParam(), 20, 5000));
  const Convolution layer(weights(3, 8, 24));
  const KernelMap map = same_map(many, 3, 1);
  const Tensor input = features(many, 8);
  EXPECT_EQ(layer(map, input, {}, 1).values, layer(map, input, {}, 3).values);
}

TEST_P(ConvolutionLaw, FoldedIsTheLayerThenTheNorm) {
  const ConvolutionWeights w = weights(3, 4, 6);
  BatchNorm norm;
  for (int c = 0; c < 6; ++c) {
    norm.mean.push_back(normal());
    norm.variance.push_back(0.5F + std::abs(normal()));
    norm.scale.push_back(normal());
    norm.shift.push_back(normal());
  }
  const KernelMap map = same_map(fine, 3, 1);
  const Tensor input = features(fine, 4);
  const Tensor bare = Convolution(w)(map, input, {}, 1),
               normed = Convolution(folded(w, norm))(map, input, {}, 1);
  for (Eigen::Index row = 0; row < bare.values.rows(); ++row)
    for (int c = 0; c < 6; ++c) {
      const auto i = static_cast<std::size_t>(c);
      const float expected = (bare.values(row, c) - norm.mean[i]) /
                                 std::sqrt(norm.variance[i] + static_cast<float>(norm.epsilon)) *
                                 norm.scale[i] +
                             norm.shift[i];
      EXPECT_NEAR(normed.values(row, c), expected, 2e-5);
    }
}

INSTANTIATE_TEST_SUITE_P(Seeds, ConvolutionLaw, testing::Range<std::uint64_t>(1, 4));

TEST(Convolution, CountsTwoPerPairAndChannels) {
  const VoxelSet line = *VoxelSet::of({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}});
  const Convolution layer(ConvolutionWeights{3, 2, 5, std::vector<float>(270), std::vector<float>(5)});
  EXPECT_EQ(layer.flops(same_map(line, 3, 1)), 2.0 * 7 * 2 * 5) << "three and the two neighbours either way";
}

}  // namespace
}  // namespace liloc::learned
