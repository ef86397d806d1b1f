#include "common/registration/points/normals.hpp"

#include <gtest/gtest.h>
#include <pcl/features/normal_3d.h>
#include <pcl/search/kdtree.h>

#include <cmath>

#include "common/geometry/pcl.hpp"
#include "common/registration/points/tests/wavy_sheet.hpp"

namespace liloc {
namespace {

class NormalLaw : public testing::TestWithParam<unsigned> {};

TEST_P(NormalLaw, AgreesWithPcl) {
  const Cloud sheet = wavy_sheet(GetParam());
  const Eigen::Vector3f sensor(0, 0, 3);
  const Cloud ours = with_normals(sheet, sensor, {0.125, 1});
  ASSERT_EQ(ours.size(), sheet.size());

  pcl::NormalEstimation<pcl::PointXYZ, pcl::Normal> estimation;
  estimation.setInputCloud(to_pcl(sheet));
  estimation.setSearchMethod(std::make_shared<pcl::search::KdTree<pcl::PointXYZ>>());
  estimation.setRadiusSearch(0.125);
  estimation.setViewPoint(0, 0, 3);
  pcl::PointCloud<pcl::Normal> reference;
  estimation.compute(reference);
  std::size_t differ = 0;
  for (std::size_t i = 0; i < ours.size(); ++i)
    differ += ours.normals[i].dot(reference[i].getNormalVector3fMap()) < 0.999F;
  EXPECT_LE(differ, ours.size() / 200);  // nearly isotropic neighbourhoods at the rim may choose another axis
}

TEST_P(NormalLaw, NormalsFaceTheSensor) {
  const Cloud below = with_normals(wavy_sheet(GetParam()), {0, 0, -3});
  for (const auto& n : below.normals) EXPECT_LT(n.z(), 0);
}

INSTANTIATE_TEST_SUITE_P(Seeds, NormalLaw, testing::Range(1U, 5U));

TEST(Normals, OfALineLieAcrossIt) {
  Cloud line;
  for (int i = 0; i < 40; ++i) line.points.emplace_back(0.03F * static_cast<float>(i), 1.0F, 2.0F);
  const Cloud ours = with_normals(line, {0, 0, 0});
  ASSERT_EQ(ours.size(), line.size());
  for (const Eigen::Vector3f& n : ours.normals) {
    EXPECT_NEAR(n.norm(), 1.0F, 1e-4F);
    EXPECT_NEAR(n.x(), 0.0F, 1e-3F);
  }
}

TEST(Normals, PointsThatHangInTheAirAreDropped) {
  Cloud sheet = wavy_sheet(1);
  const std::size_t kept = with_normals(sheet, {0, 0, 3}).size();
  sheet.points.emplace_back(0.0F, 0.0F, 2.0F);
  sheet.points.emplace_back(NAN, 0.0F, 2.0F);
  EXPECT_EQ(with_normals(sheet, {0, 0, 3}).size(), kept);
  EXPECT_TRUE(with_normals({}, {0, 0, 0}).empty());
}

TEST(Normals, NeighbourhoodsOfASparseCloudWidenUntilAThirdHoldsTogether) {
  const Eigen::Vector3f sensor(0, 0, 3);
  Cloud sparse;
  for (int i = 0; i < 400; ++i)
    sparse.points.emplace_back(0.15F * static_cast<float>(i % 20), 0.15F * static_cast<float>(i / 20), 0.0F);
  EXPECT_TRUE(with_normals(sparse, sensor, {0.125, 5}).empty());
  EXPECT_TRUE(with_normals(sparse, sensor, {0.125, 5, 0.18}).empty()) << "the next step is beyond the widest";
  const Cloud wide = with_normals(sparse, sensor, {0.125, 5, 0.4});
  EXPECT_EQ(wide.points, with_normals(sparse, sensor, {0.1875, 5}).points);
  EXPECT_EQ(wide.size(), 18U * 18U) << "those at the rim have four neighbours, themselves among them";
}

TEST(Normals, ACloudThatHoldsTogetherIsNotWidened) {
  const Cloud sheet = wavy_sheet(2);
  const Cloud usual = with_normals(sheet, {0, 0, 3}, {0.125, 5}),
              wide = with_normals(sheet, {0, 0, 3}, {0.125, 5, 0.4});
  EXPECT_EQ(wide.points, usual.points);
  EXPECT_EQ(wide.normals, usual.normals);
}

}  // namespace
}  // namespace liloc
