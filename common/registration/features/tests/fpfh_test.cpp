#include "common/registration/features/fpfh.hpp"

#include <gtest/gtest.h>
#include <pcl/features/fpfh.h>
#include <pcl/search/kdtree.h>

#include <numeric>

#include "common/geometry/pcl.hpp"
#include "common/testing/watched_room.hpp"

namespace liloc {
namespace {

Cloud described_cloud(unsigned seed) {
  return watched_room(seed).query.medium;
}

std::vector<std::uint32_t> all_of(const Cloud& cloud) {
  std::vector<std::uint32_t> index(cloud.size());
  std::iota(index.begin(), index.end(), 0U);
  return index;
}

class FpfhLaw : public testing::TestWithParam<unsigned> {};

TEST_P(FpfhLaw, AgreesWithPcl) {
  const Cloud cloud = described_cloud(GetParam());
  pcl::FPFHEstimation<pcl::PointXYZ, pcl::Normal, pcl::FPFHSignature33> estimation;
  estimation.setInputCloud(to_pcl(cloud));
  estimation.setInputNormals(normals_to_pcl(cloud));
  estimation.setSearchMethod(std::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
  estimation.setRadiusSearch(0.4);
  pcl::PointCloud<pcl::FPFHSignature33> reference;
  estimation.compute(reference);
  const Features ours = fpfh(cloud, all_of(cloud), 0.4);
  ASSERT_EQ(ours.size(), reference.size());
  std::size_t differ = 0;
  for (std::size_t i = 0; i < ours.size(); ++i) {
    const Eigen::Map<const Eigen::Matrix<float, 33, 1>> expected(reference[i].histogram);
    differ += (ours.descriptors.col(static_cast<Eigen::Index>(i)) - expected).norm() >
              0.02F * expected.norm() + 1e-3F;
  }
  EXPECT_LE(differ, ours.size() / 50);  // an angle on the edge of a bin may fall to either side
}

TEST_P(FpfhLaw, DoesNotChangeWhenTheCloudMoves) {
  const Cloud cloud = described_cloud(GetParam());
  Vector6d a;
  a << 0.4, -0.8, 1.1, 2, -3, 1;
  const Features here = fpfh(cloud, all_of(cloud), 0.4),
                 there = fpfh(transformed(increment(a), cloud), all_of(cloud), 0.4);
  EXPECT_LT((here.descriptors - there.descriptors).norm(), 0.05F * here.descriptors.norm());
}

TEST_P(FpfhLaw, APartIsDescribedAsInTheWhole) {
  const Cloud cloud = described_cloud(GetParam());
  const Features whole = fpfh(cloud, all_of(cloud), 0.4);
  const Features part = fpfh(cloud, sample_indices(cloud.size(), 0.2, GetParam()), 0.4);
  ASSERT_GT(part.size(), 10U);
  for (std::size_t i = 0; i < part.size(); ++i)
    EXPECT_TRUE(
        part.descriptors.col(static_cast<Eigen::Index>(i)).isApprox(whole.descriptors.col(part.index[i])));
}

INSTANTIATE_TEST_SUITE_P(Seeds, FpfhLaw, testing::Range(1U, 4U));

TEST(SampleIndices, FollowsShareAndSeed) {
  EXPECT_EQ(sample_indices(1000, 1.0, 1).size(), 1000U);
  EXPECT_TRUE(sample_indices(1000, 0.0, 1).empty());
  EXPECT_EQ(sample_indices(1000, 0.3, 5), sample_indices(1000, 0.3, 5));
  EXPECT_NEAR(static_cast<double>(sample_indices(10000, 0.3, 5).size()), 3000, 200);
}

}  // namespace
}  // namespace liloc
