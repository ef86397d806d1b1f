#include "common/geometry/voxel.hpp"

#include <gtest/gtest.h>
#include <pcl/filters/voxel_grid.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "common/geometry/pcl.hpp"

namespace liloc {
namespace {

Cloud random_cloud(unsigned seed, std::size_t count) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<float> unit(-2, 2);
  Cloud cloud;
  for (std::size_t i = 0; i < count; ++i) cloud.points.emplace_back(unit(rng), unit(rng), unit(rng));
  return cloud;
}

void sort_points(std::vector<Eigen::Vector3f>& points) {
  std::sort(points.begin(), points.end(), [](const auto& a, const auto& b) {
    return std::lexicographical_compare(a.data(), a.data() + 3, b.data(), b.data() + 3);
  });
}

class VoxelLaw : public testing::TestWithParam<unsigned> {};

TEST_P(VoxelLaw, AgreesWithPcl) {
  const Cloud cloud = random_cloud(GetParam(), 5000);
  pcl::VoxelGrid<pcl::PointXYZ> filter;
  filter.setInputCloud(to_pcl(cloud));
  filter.setLeafSize(0.25F, 0.25F, 0.25F);
  pcl::PointCloud<pcl::PointXYZ> reference;
  filter.filter(reference);
  std::vector<Eigen::Vector3f> expected = from_pcl(reference).points,
                               ours = voxel_downsample(cloud, 0.25).points;
  ASSERT_EQ(ours.size(), expected.size());
  sort_points(ours);
  sort_points(expected);
  for (std::size_t i = 0; i < ours.size(); ++i) EXPECT_LT((ours[i] - expected[i]).norm(), 1e-4F);
}

TEST_P(VoxelLaw, KeepsTheMeanAndUnitNormals) {
  Cloud cloud = random_cloud(GetParam(), 1000);
  for (const auto& p : cloud.points) cloud.normals.push_back(p.normalized());
  const Cloud one = voxel_downsample(cloud, 100.0);
  EXPECT_LE(one.size(), 8U);
  for (const auto& n : voxel_downsample(cloud, 0.5).normals) EXPECT_NEAR(n.norm(), 1.0F, 1e-5F);
}

INSTANTIATE_TEST_SUITE_P(Seeds, VoxelLaw, testing::Range(1U, 9U));

TEST(Voxel, NonFinitePointsAreDropped) {
  Cloud cloud;
  cloud.points = {{0.1F, 0.1F, 0.1F}, {NAN, 0, 0}, {INFINITY, 0, 0}};
  EXPECT_EQ(voxel_downsample(cloud, 0.05).size(), 1U);
  EXPECT_TRUE(voxel_downsample({}, 0.05).empty());
}

}  // namespace
}  // namespace liloc
