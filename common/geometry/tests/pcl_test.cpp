#include "common/geometry/pcl.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace liloc {
namespace {

TEST(Pcl, PointsAndNormalsComeAcrossInOrderAndPointsBack) {
  const Cloud cloud{{{1, 2, 3}, {-4, 5, 0}}, {{0, 0, 1}, {1, 0, 0}}};
  const auto points = to_pcl(cloud);
  const auto normals = normals_to_pcl(cloud);
  ASSERT_EQ(points->size(), 2U);
  ASSERT_EQ(normals->size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ((*points)[i].getVector3fMap(), cloud.points[i]);
    EXPECT_EQ((*normals)[i].getNormalVector3fMap(), cloud.normals[i]);
  }
  EXPECT_EQ(from_pcl(*points).points, cloud.points);
}

TEST(Pcl, WhatIsNoNumberIsDropped) {
  pcl::PointCloud<pcl::PointXYZ> cloud;
  cloud.emplace_back(1.0F, 2.0F, 3.0F);
  cloud.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F);
  cloud.emplace_back(0.0F, std::numeric_limits<float>::infinity(), 0.0F);
  const Cloud ours = from_pcl(cloud);
  ASSERT_EQ(ours.size(), 1U);
  EXPECT_EQ(ours.points[0], Eigen::Vector3f(1, 2, 3));
}

}  // namespace
}  // namespace liloc
