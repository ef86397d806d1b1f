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

TEST_P(VoxelLaw, ALimitKeepsASpreadSubset) {
  const Cloud cloud = random_cloud(GetParam(), 20'000);
  const Cloud all = voxel_downsample(cloud, 0.25);
  for (const std::size_t most : {std::size_t{1}, all.size() / 3, all.size() - 1}) {
    Cloud some = voxel_downsample(cloud, 0.25, most), sorted = all;
    EXPECT_LE(some.size(), most);
    sort_points(some.points);
    sort_points(sorted.points);
    EXPECT_TRUE(std::includes(sorted.points.begin(), sorted.points.end(), some.points.begin(),
                              some.points.end(), [](const auto& a, const auto& b) {
                                return std::lexicographical_compare(a.data(), a.data() + 3, b.data(),
                                                                    b.data() + 3);
                              }));
  }
  EXPECT_EQ(voxel_downsample(cloud, 0.25, all.size()).size(), all.size());
}

INSTANTIATE_TEST_SUITE_P(Seeds, VoxelLaw, testing::Range(1U, 9U));

TEST(Voxel, ALimitThinsTheWallAndLeavesThePole) {
  Cloud cloud;
  for (int i = 0; i < 60; ++i)
    for (int j = 0; j < 60; ++j) cloud.points.emplace_back(0.05F * i + 0.02F, 0.05F * j + 0.02F, 3.02F);
  for (int j = 0; j < 40; ++j) cloud.points.emplace_back(1.52F, 0.05F * j + 0.02F, 1.52F);
  const Cloud thin = voxel_downsample(cloud, 0.05, 1900);
  const auto pole = [](const Eigen::Vector3f& p) { return p.z() < 2; };
  EXPECT_EQ(std::count_if(thin.points.begin(), thin.points.end(), pole), 40);
  EXPECT_GT(thin.size(), 1800U);
  for (const auto& p : cloud.points)  // of the wall every other voxel stays: none is farther than its neighbour
    EXPECT_TRUE(std::any_of(thin.points.begin(), thin.points.end(),
                            [&](const Eigen::Vector3f& q) { return (p - q).norm() < 0.051F; }));
}

TEST(Voxel, MoreBlocksThanPointsAreThinnedEvenly) {
  Cloud cloud;
  for (int i = 0; i < 100; ++i) cloud.points.emplace_back(static_cast<float>(i), 0.0F, 0.0F);
  const Cloud thin = voxel_downsample(cloud, 0.05, 30);  // each point is a block
  EXPECT_LE(thin.size(), 30U);
  EXPECT_GE(thin.size(), 25U);
  float low = 100, high = 0;
  for (const auto& p : thin.points) {
    low = std::min(low, p.x());
    high = std::max(high, p.x());
  }
  EXPECT_LT(low, 4);
  EXPECT_GT(high, 95);
}

TEST(Voxel, NonFinitePointsAreDropped) {
  Cloud cloud;
  cloud.points = {{0.1F, 0.1F, 0.1F}, {NAN, 0, 0}, {INFINITY, 0, 0}};
  EXPECT_EQ(voxel_downsample(cloud, 0.05).size(), 1U);
  EXPECT_TRUE(voxel_downsample({}, 0.05).empty());
}

}  // namespace
}  // namespace liloc
