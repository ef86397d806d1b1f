#include "common/learned/layer_weights.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "common/learned/tests/random_network.hpp"

namespace liloc::learned {
namespace {

using testing::HasSubstr;

/// "" where it works.
std::string trouble_of(const WeightsFile& file, const std::string& layer, const std::string& norm,
                       int inputs = 0, int width = 0) {
  const auto taken = LayerWeights(file).convolution(layer, norm, inputs, width);
  return taken ? "" : taken.error().message;
}

TEST(LayerWeights, TakesALayerWithItsNorm) {
  const WeightsFile file = RandomWeights::of(1, {});
  const auto layer = LayerWeights(file).convolution("conv2", "norm2", 4, 3);
  ASSERT_TRUE(layer) << layer.error().message;
  EXPECT_EQ(layer->width, 3);
  EXPECT_EQ(layer->inputs, 4);
  EXPECT_EQ(layer->outputs, 8);
  const auto& kernel = file.arrays.at("conv2.kernel").values;
  const auto& scale = file.arrays.at("norm2.bn.weight").values;
  const auto& variance = file.arrays.at("norm2.bn.running_var").values;
  EXPECT_NEAR(layer->matrices[13], kernel[13] * scale[5] / std::sqrt(variance[5] + 1e-5F), 1e-5)
      << "the sixth of eight channels";
}

TEST(LayerWeights, OneOffsetHasTwoAxesOrThree) {
  WeightsFile file = RandomWeights::of(1, {});
  EXPECT_EQ(trouble_of(file, "final", "", 4, 1), "");
  auto& shape = file.arrays.at("final.kernel").shape;
  shape.insert(shape.begin(), 1);
  EXPECT_EQ(trouble_of(file, "final", "", 4, 1), "") << "as old checkpoints have it";
}

TEST(LayerWeights, AddsTheBias) {
  const WeightsFile file = RandomWeights::of(1, {});
  EXPECT_EQ(LayerWeights(file).convolution("final", "", 4)->bias, file.arrays.at("final.bias").values);
}

TEST(LayerWeights, NamesWhatDoesNotFit) {
  WeightsFile file = RandomWeights::of(1, {});
  EXPECT_THAT(trouble_of(file, "conv9", ""), HasSubstr("conv9.kernel is missing"));
  EXPECT_THAT(trouble_of(file, "conv2", "norm9"), HasSubstr("norm9.bn.running_mean is missing"));
  EXPECT_THAT(trouble_of(file, "conv2", "norm1"), HasSubstr("norm1.bn.running_mean has 4 values, not 8"));
  EXPECT_THAT(trouble_of(file, "conv2", "norm2", 5),
              HasSubstr("takes 4 channels; what comes before it gives 5"));
  EXPECT_THAT(trouble_of(file, "conv1", "norm1", 1, 3), HasSubstr("is 5 wide, not 3"));
  file.arrays["norm2.bn.running_var"].values[3] = -1;
  EXPECT_THAT(trouble_of(file, "conv2", "norm2"), HasSubstr("negative"));
  file.arrays["final.bias"].values.pop_back();
  EXPECT_THAT(trouble_of(file, "final", ""), HasSubstr("final.bias has 5 values, not 6"));
  for (const std::vector<std::size_t>& shape :
       {std::vector<std::size_t>{64, 4, 8}, {8, 27 * 8}, {1, 1, 1, 1}, {27}, {27, 5000, 1}}) {
    file.arrays["conv2.kernel"].shape = shape;
    EXPECT_NE(trouble_of(file, "conv2", "norm2", 4, 3), "");
  }
}

}  // namespace
}  // namespace liloc::learned
