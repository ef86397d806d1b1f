#include "common/learned/describer.hpp"

#include <gmock/gmock.h>

#include <fstream>
#include <limits>
#include <random>

#include "common/learned/tests/random_network.hpp"
#include "common/learned/tests/weights_bytes.hpp"

namespace liloc::learned {
namespace {

using testing::HasSubstr;

constexpr float kVoxel_m = 0.025F;

std::shared_ptr<const FeatureNetwork> network() {
  return std::make_shared<const FeatureNetwork>(*FeatureNetwork::of(RandomWeights::of(1, {})));
}

/// Points on two walls, about 400 a square metre and wall.
Cloud walls(std::uint64_t seed) {
  std::mt19937_64 rng(seed);
  std::uniform_real_distribution<float> any(0, 1.5F);
  Cloud cloud;
  for (int i = 0; i < 2000; ++i) {
    cloud.points.emplace_back(any(rng), any(rng), 0.01F);
    cloud.points.emplace_back(any(rng), -0.4F, any(rng));
  }
  return cloud;
}

std::vector<std::uint32_t> every(const Cloud& cloud, std::uint32_t step) {
  std::vector<std::uint32_t> index;
  for (std::uint32_t i = 0; i < cloud.size(); i += step) index.push_back(i);
  return index;
}

TEST(Describer, GivesEachPointWhatItsVoxelHas) {
  const auto net = network();
  const Cloud cloud = walls(1);
  const auto index = every(cloud, 3);
  const Features features = describer_of(net, 2)(cloud, cloud, index);
  EXPECT_EQ(features.index, index);
  ASSERT_EQ(features.descriptors.rows(), net->dimensions());
  std::vector<Eigen::Vector3i> voxels;
  for (const Eigen::Vector3f& p : cloud.points) voxels.emplace_back((p.array() / kVoxel_m).floor().cast<int>());
  const VoxelSet set = *VoxelSet::of(voxels);
  const Tensor rows = (*net)(net->maps(set, 1), 1);
  for (std::size_t i = 0; i < index.size(); ++i)
    EXPECT_EQ(features.descriptors.col(static_cast<Eigen::Index>(i)),
              rows.values.row(set.find(voxels[index[i]])).head(net->dimensions()).transpose());
}

TEST(Describer, TakesTheNearestVoxelAndLeavesOutWhatHasNone) {
  const Cloud dense = walls(2);
  Cloud thinned;
  thinned.points = {dense.points[0] + Eigen::Vector3f(0, 0, 0.06F),
                    {5, 5, 5},
                    dense.points[8],
                    Eigen::Vector3f::Constant(std::numeric_limits<float>::quiet_NaN()),
                    {1e30F, 0, 0}};
  const Features features = describer_of(network(), 1)(dense, thinned, {0, 1, 2, 3, 4});
  EXPECT_EQ(features.index, (std::vector<std::uint32_t>{0, 2}));
  EXPECT_EQ(features.descriptors.cols(), 2);
}

TEST(Describer, ShiftedByWholeStridesItDescribesAlike) {
  const Cloud cloud = walls(3);
  Cloud moved = cloud;
  for (Eigen::Vector3f& p : moved.points) p += Eigen::Vector3f(0.8F, -0.4F, 1.2F);  // multiples of four voxels
  const auto describe = describer_of(network(), 1);
  const Features here = describe(cloud, cloud, every(cloud, 5)),
                 there = describe(moved, moved, every(moved, 5));
  int alike = 0;
  for (Eigen::Index i = 0; i < here.descriptors.cols(); ++i)
    alike += (here.descriptors.col(i) - there.descriptors.col(i)).norm() < 0.05F ? 1 : 0;
  EXPECT_GT(alike, here.descriptors.cols() * 9 / 10) << "but for points that rounding puts next door";
}

TEST(Describer, OfNothingDescribesNothing) {
  const Features features = describer_of(network(), 1)({}, {}, {});
  EXPECT_EQ(features.size(), 0U);
  EXPECT_EQ(features.descriptors.cols(), 0);
}

std::string trouble_of(std::string_view features, const std::filesystem::path& weights) {
  const auto describer = describer_from(features, weights, 1);
  return describer ? "" : describer.error().message;
}

TEST(DescriberFrom, TellsWhatGoesTogether) {
  EXPECT_EQ(trouble_of("fpfh", ""), "");
  EXPECT_FALSE(*describer_from("fpfh", "", 1)) << "FPFH is what an empty one stands for";
  EXPECT_THAT(trouble_of("learned", ""), HasSubstr("--weights FILE"));
  EXPECT_THAT(trouble_of("learned", ""), HasSubstr("convert_fcgf.py"));
  EXPECT_THAT(trouble_of("fpfh", "some.safetensors"), HasSubstr("--features learned"));
  EXPECT_THAT(trouble_of("d3feat", ""), HasSubstr("'d3feat' is unknown"));
  EXPECT_THAT(trouble_of("learned", "/no/such/file"), HasSubstr("--weights: /no/such/file"));
}

TEST(DescriberFrom, TakesAFileOfWeights) {
  const std::filesystem::path path =
      std::filesystem::path(testing::TempDir()) / "liloc_describer_test.safetensors";
  std::ofstream(path, std::ios::binary) << bytes_of(RandomWeights::of(1, {}));
  const auto describer = describer_from("learned", path, 1);
  std::filesystem::remove(path);
  ASSERT_TRUE(describer) << describer.error().message;
  const Cloud cloud = walls(1);
  EXPECT_EQ((*describer)(cloud, cloud, {0}).descriptors.rows(), 6);
}

}  // namespace
}  // namespace liloc::learned
