#include "common/geometry/cloud.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

const Eigen::Vector3f kUp = Eigen::Vector3f::UnitZ();

TEST(Append, KeepsNormalsBesideACloudWithoutPoints) {  // a ceiling LiDAR that is covered sees nothing
  const Cloud floor{{{0, 0, 0}, {1, 0, 0}}, {kUp, kUp}};
  Cloud first, last = floor;
  append(first, floor);
  append(last, Cloud{});
  for (const Cloud& cloud : {first, last}) {
    EXPECT_EQ(cloud.size(), 2U);
    EXPECT_TRUE(cloud.has_normals());
  }
}

TEST(Append, DropsNormalsThatOneSideLacks) {
  const Cloud with{{{0, 0, 0}}, {kUp}}, without{{{1, 0, 0}}, {}};
  Cloud a = with, b = without;
  append(a, without);
  append(b, with);
  for (const Cloud& cloud : {a, b}) {
    EXPECT_EQ(cloud.size(), 2U);
    EXPECT_FALSE(cloud.has_normals());
  }
}

}  // namespace
}  // namespace liloc
