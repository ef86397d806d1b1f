#include "common/learned/feature_network.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "common/learned/tests/dense_reference.hpp"
#include "common/learned/tests/random_network.hpp"
#include "common/learned/tests/weights_bytes.hpp"

namespace liloc::learned {
namespace {

using testing::HasSubstr;

/// The network as it is published, over a dense grid: masked to the voxels after every layer.
class DenseNetwork {
 public:
  DenseNetwork(const WeightsFile& file, const VoxelSet& set, std::size_t levels) : file_(file) {
    sets_.push_back(set);
    while (sets_.size() < levels) sets_.push_back(sets_.back().halved());
  }

  /// Descriptors of unit length. The box: corners divisible by two to the power of the levels.
  DenseGrid operator()(const Eigen::Vector3i& low, const Eigen::Vector3i& size) const {
    DenseGrid x(low, size, 1);
    for (std::size_t row = 0; row < sets_[0].size(); ++row) *x.at(sets_[0].voxel(row)) = 1;
    std::vector<DenseGrid> seen;
    for (std::size_t i = 0; i < sets_.size(); ++i) {
      const std::string n = std::to_string(i + 1);
      x = block("block" + n, layer("conv" + n, "norm" + n, x, i, i == 0 ? Stride::one : Stride::two), i);
      seen.push_back(x);
    }
    for (std::size_t i = sets_.size() - 1; i > 0; --i) {
      const std::string n = std::to_string(i + 1);
      x = layer("conv" + n + "_tr", "norm" + n + "_tr", x, i - 1, Stride::two_transposed);
      x = beside(block("block" + n + "_tr", x, i - 1), seen[i - 1]);
    }
    x = layer("final", "", rectified(layer("conv1_tr", "", x, 0, Stride::one)), 0, Stride::one);
    x.for_each_voxel([&](const Eigen::Vector3i& v) {
      Eigen::Map<Eigen::VectorXd> descriptor(x.at(v), x.channels);
      descriptor.normalize();
    });
    return x;
  }

 private:
  [[nodiscard]] const std::vector<float>& values(const std::string& name) const {
    return file_.arrays.at(name).values;
  }

  [[nodiscard]] DenseGrid layer(const std::string& name, const std::string& norm, const DenseGrid& in,
                                std::size_t level, Stride stride) const {
    const auto& kernel = file_.arrays.at(name + ".kernel");
    const std::size_t volume = kernel.shape.size() == 3 ? kernel.shape[0] : 1;
    ConvolutionWeights w{static_cast<int>(std::lround(std::cbrt(volume))), in.channels,
                         static_cast<int>(kernel.shape.back()), kernel.values,
                         std::vector<float>(kernel.shape.back(), 0)};
    if (file_.arrays.contains(name + ".bias")) w.bias = values(name + ".bias");
    DenseGrid out = dense_convolution(in, w, stride);
    if (!norm.empty())
      out.for_each_voxel([&](const Eigen::Vector3i& v) {
        for (std::size_t c = 0; c < w.bias.size(); ++c) {
          const auto of = [&](const char* what) {
            return static_cast<double>(values(norm + ".bn." + what)[c]);
          };
          double& x = out.at(v)[c];
          x = (x - of("running_mean")) / std::sqrt(of("running_var") + 1e-5) * of("weight") + of("bias");
        }
      });
    return masked(std::move(out), sets_[level]);
  }

  [[nodiscard]] DenseGrid block(const std::string& name, const DenseGrid& in, std::size_t level) const {
    const DenseGrid middle = rectified(layer(name + ".conv1", name + ".norm1", in, level, Stride::one));
    DenseGrid out = layer(name + ".conv2", name + ".norm2", middle, level, Stride::one);
    for (std::size_t i = 0; i < out.values.size(); ++i) out.values[i] += in.values[i];
    return rectified(std::move(out));
  }

  static DenseGrid rectified(DenseGrid grid) {
    for (double& v : grid.values) v = std::max(v, 0.0);
    return grid;
  }
  static DenseGrid beside(DenseGrid a, DenseGrid b) {
    DenseGrid result(a.low, a.size, a.channels + b.channels);
    result.for_each_voxel([&](const Eigen::Vector3i& v) {
      std::copy_n(a.at(v), a.channels, result.at(v));
      std::copy_n(b.at(v), b.channels, result.at(v) + a.channels);
    });
    return result;
  }

  const WeightsFile& file_;
  std::vector<VoxelSet> sets_;
};

class NetworkLaw : public testing::TestWithParam<std::uint64_t> {
 protected:
  const VoxelSet set = *VoxelSet::of(random_voxels(GetParam(), 8, 700));
};

TEST_P(NetworkLaw, IsTheDenseOne) {
  const Eigen::Vector3i low(-8, -8, -8), size(16, 16, 16);
  for (const RandomWeights::Shape& shape :
       {RandomWeights::Shape{}, {{3, 5}, {7, 2}, 3, 4}, {{2, 3, 4, 5}, {5, 4, 3, 2}, 7, 16}}) {
    const WeightsFile file = RandomWeights::of(GetParam(), shape);
    const auto network = FeatureNetwork::of(file);
    ASSERT_TRUE(network) << network.error().message;
    const Tensor sparse = (*network)(network->maps(set, 1), 1);
    EXPECT_EQ(sparse.channels, static_cast<int>(shape.dimensions));
    EXPECT_LT(difference(sparse, set, DenseNetwork(file, set, shape.down.size())(low, size)), 1e-5);
  }
}

TEST_P(NetworkLaw, ThreadsChangeNoBit) {
  const auto network = FeatureNetwork::of(RandomWeights::of(GetParam(), {}));
  EXPECT_EQ((*network)(network->maps(set, 1), 1).values, (*network)(network->maps(set, 4), 4).values);
}

/// Moved by what all levels divide, a cloud is described alike.
TEST_P(NetworkLaw, MovesWithTheCloud) {
  const auto network = FeatureNetwork::of(RandomWeights::of(GetParam(), {}));
  std::vector<Eigen::Vector3i> moved = random_voxels(GetParam(), 8, 700);
  for (Eigen::Vector3i& v : moved) v += Eigen::Vector3i(4, -8, 12);
  const VoxelSet there = *VoxelSet::of(moved);
  const Tensor here = (*network)(network->maps(set, 1), 1), of_moved = (*network)(network->maps(there, 1), 1);
  for (std::size_t row = 0; row < set.size(); ++row) {
    const std::int32_t other = there.find(set.voxel(row) + Eigen::Vector3i(4, -8, 12));
    ASSERT_GE(other, 0);
    EXPECT_LT((here.values.row(static_cast<Eigen::Index>(row)) - of_moved.values.row(other)).norm(), 1e-5F);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, NetworkLaw, testing::Range<std::uint64_t>(1, 4));

TEST(FeatureNetwork, ThePapersHasItsSize) {
  const WeightsFile file = RandomWeights::of(1, RandomWeights::paper());
  const auto network = FeatureNetwork::of(file);
  ASSERT_TRUE(network) << network.error().message;
  EXPECT_EQ(network->dimensions(), 32);
  EXPECT_EQ(network->voxel_size_m(), 0.025);
  const VoxelSet one = *VoxelSet::of({{0, 0, 0}});
  const NetworkMaps maps = network->maps(one, 1);
  const double layers = 32 + 2 * (32 * 32 + 64 * 64 + 128 * 128 + 256 * 256) + 32 * 64 + 64 * 128 + 128 * 256 +
                        256 * 128 + 256 * 64 + 128 * 64 + 2 * (128 * 128 + 64 * 64 + 64 * 64) + 96 * 64 +
                        64 * 32;
  EXPECT_EQ(network->flops(maps), 2 * layers) << "of a lone voxel, that is one offset a layer";
  EXPECT_NEAR((*network)(maps, 1).values.row(0).norm(), 1, 1e-5);
}

TEST(FeatureNetwork, OfNoVoxelsGivesNone) {
  const auto network = FeatureNetwork::of(RandomWeights::of(1, {}));
  EXPECT_EQ((*network)(network->maps(*VoxelSet::of({}), 2), 2).size(), 0U);
}

TEST(FeatureNetwork, NormalizesUnlessToldNotTo) {
  WeightsFile file = RandomWeights::of(1, {});
  file.about["normalize"] = "false";
  const auto network = FeatureNetwork::of(file);
  const VoxelSet set = *VoxelSet::of(random_voxels(1, 4, 50));
  const Tensor raw = (*network)(network->maps(set, 1), 1);
  EXPECT_GT(std::abs(raw.values.row(0).norm() - 1), 1e-3F);
}

TEST(FeatureNetwork, NamesWhatIsMissing) {
  const WeightsFile whole = RandomWeights::of(1, {});
  for (const auto& [name, array] : whole.arrays) {
    WeightsFile file = whole;
    file.arrays.erase(name);
    const auto network = FeatureNetwork::of(file);
    if (name == "final.bias" || name == "conv3.kernel") continue;  // may lack; makes another, smaller network
    ASSERT_FALSE(network) << name;
    EXPECT_THAT(network.error().message, testing::AnyOf(HasSubstr(name), HasSubstr("levels"))) << name;
  }
}

TEST(FeatureNetwork, RefusesVoxelSizesThatAreNone) {
  WeightsFile file = RandomWeights::of(1, {});
  for (const char* text : {"", "nan", "inf", "-1", "0", "2.5 cm", "100", "0.025x"}) {
    file.about["voxel_size_m"] = text;
    const auto network = FeatureNetwork::of(file);
    ASSERT_FALSE(network) << text;
    EXPECT_THAT(network.error().message, HasSubstr("voxel_size_m"));
  }
  file.about.clear();
  EXPECT_FALSE(FeatureNetwork::of(file));
}

TEST(FeatureNetwork, RefusesColour) {
  RandomWeights::Shape shape;
  WeightsFile file = RandomWeights::of(1, shape);
  file.arrays["conv1.kernel"].shape = {125, 3, 4};
  file.arrays["conv1.kernel"].values.resize(1500);
  const auto network = FeatureNetwork::of(file);
  ASSERT_FALSE(network);
  EXPECT_THAT(network.error().message, HasSubstr("conv1.kernel takes 3 channels"));
}

TEST(FeatureNetwork, LoadsAFileAndNamesTheConverter) {
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) / "liloc_feature_network_test.safetensors";
  std::ofstream(path, std::ios::binary) << bytes_of(RandomWeights::of(1, {}));
  const auto network = FeatureNetwork::load(path);
  EXPECT_TRUE(network) << network.error().message;
  std::filesystem::remove(path);
  const auto none = FeatureNetwork::load(path);
  ASSERT_FALSE(none);
  EXPECT_THAT(none.error().message, HasSubstr(path.string()));
  EXPECT_THAT(none.error().message, HasSubstr("convert_fcgf.py"));
}

}  // namespace
}  // namespace liloc::learned
