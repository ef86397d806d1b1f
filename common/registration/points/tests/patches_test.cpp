#include "common/registration/points/patches.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

using Vector6f = PatchWeights::Vector6f;

constexpr float kVariance = 0.008F * 0.008F;

Vector6f along_x() {
  return (Vector6f() << 0, 0, 0, 1, 0, 0).finished();
}

/// Pairs that are all off by `residual_m`, in one patch.
float weight_of(int pairs, float residual_m, float doubt_m, const PatchOptions& options = {}) {
  PatchWeights sums(1);
  for (int i = 0; i < pairs; ++i) sums.add(0, 0.7F, residual_m, kVariance, along_x());
  const PatchWeights::Matrix6f doubt = doubt_m * doubt_m * PatchWeights::Matrix6f::Identity();
  return sums.weights(doubt, options).front();
}

TEST(Patches, PointsOfOneCubeThatFaceTheSameWayAreOnePatch) {
  PatchNumbers numbers(0.4);
  const Eigen::Vector3f here(0.1F, 0.1F, 0.1F), near(0.3F, 0.3F, 0.3F), far(0.5F, 0.1F, 0.1F);
  EXPECT_EQ(numbers.of(here, {1, 0.2F, 0}), 0U);
  EXPECT_EQ(numbers.of(near, {0.9F, -0.3F, 0.1F}), 0U);
  EXPECT_EQ(numbers.of(near, {-1, 0, 0}), 1U);
  EXPECT_EQ(numbers.of(here, {0, 1, 0}), 2U);
  EXPECT_EQ(numbers.of(far, {1, 0, 0}), 3U);
  EXPECT_EQ(numbers.count(), 4U);
}

TEST(Patches, HoweverManyItsPointsAPatchTellsNoMoreThanItsCommonErrorAllows) {
  const PatchOptions options;
  const double most = options.lasting / (options.common_sd_m * options.common_sd_m);
  double last = 0;
  for (const int pairs : {1, 4, 16, 64, 4096}) {
    const double information = pairs * weight_of(pairs, 0, 0) / kVariance;
    EXPECT_GT(information, last);
    EXPECT_LE(information, 1.001 * most);
    last = information;
  }
  EXPECT_NEAR(last / most, 1, 0.01);
}

TEST(Patches, APatchThatIsOffByMoreThanNoiseAndGuessExplainHardlyCounts) {
  EXPECT_GT(weight_of(50, 0.005F, 0) / weight_of(50, 0, 0), 0.9F);
  EXPECT_LT(weight_of(50, 0.06F, 0) / weight_of(50, 0, 0), 0.05F);
  EXPECT_GT(weight_of(50, 0.06F, 0.06F) / weight_of(50, 0, 0.06F), 0.7F);  // the pose may be off by as much
}

TEST(Patches, ErrorsOfItsPointsThatCancelAreNoise) {
  PatchWeights sums(1), still(1);
  for (int i = 0; i < 20; ++i) {
    sums.add(0, 1, i % 2 == 0 ? 0.02F : -0.02F, kVariance, along_x());
    still.add(0, 1, 0, kVariance, along_x());
  }
  const PatchWeights::Matrix6f sure = PatchWeights::Matrix6f::Zero();
  EXPECT_FLOAT_EQ(sums.weights(sure, {}).front(), still.weights(sure, {}).front());
}

TEST(Patches, AnEmptyPatchHasNoWeight) {
  EXPECT_EQ(PatchWeights(2).weights(PatchWeights::Matrix6f::Identity(), {}), std::vector<float>({0, 0}));
}

}  // namespace
}  // namespace liloc
