#include "common/registration/points/surfels.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace liloc {
namespace {

class SurfelLaw : public testing::TestWithParam<unsigned> {};

/// Noisy points of a plane through `centre`.
Cloud plane(const Eigen::Vector3f& normal, const Eigen::Vector3f& centre, float noise_m, unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<float> side(-0.5F, 0.5F);
  std::normal_distribution<float> noise(0, noise_m);
  const Eigen::Vector3f a = normal.unitOrthogonal(), b = normal.cross(a);
  Cloud cloud;
  for (int i = 0; i < 20'000; ++i)
    cloud.points.push_back(centre + side(rng) * a + side(rng) * b + noise(rng) * normal);
  return cloud;
}

TEST_P(SurfelLaw, MeansLieOnThePlaneAndNormalsFaceTheSensor) {
  std::mt19937 rng(GetParam());
  std::normal_distribution<float> unit;
  const Eigen::Vector3f normal = Eigen::Vector3f(unit(rng), unit(rng), unit(rng)).normalized();
  const Eigen::Vector3f centre = -2.0F * normal;  // the sensor at the origin sees it along its normal
  const auto surfels = extract_surfels(plane(normal, centre, 0.005F, GetParam()), Eigen::Vector3f::Zero());
  ASSERT_GT(surfels.size(), 50U);
  double off = 0, turned = 0, points = 0;
  for (const Surfel& s : surfels) {
    EXPECT_NEAR(s.normal.norm(), 1.0F, 1e-4F);
    EXPECT_LT(s.normal.dot(s.mean), 0);
    EXPECT_GE(s.count, 6);
    points += s.count;
    off += s.count * std::abs(normal.dot(s.mean - centre));
    turned += s.count * std::acos(std::min(1.0F, std::abs(s.normal.dot(normal))));
  }
  EXPECT_LT(off / points, 0.0015);  // a third of the noise of one point
  EXPECT_LT(turned / points, 0.08);
}
INSTANTIATE_TEST_SUITE_P(Seeds, SurfelLaw, testing::Range(1U, 9U));

TEST(Surfels, ABallIsNotFlatAndAPlaneIs) {
  const auto flat =
      extract_surfels(plane(Eigen::Vector3f::UnitZ(), {0.05F, 0.05F, -1.95F}, 0.001F, 3), {0, 0, 0});
  std::mt19937 rng(4);
  std::normal_distribution<float> unit;
  Cloud ball;
  for (int i = 0; i < 500; ++i)
    ball.points.push_back(Eigen::Vector3f(0.05F, 0.05F, 1.05F) +
                          0.01F * Eigen::Vector3f(unit(rng), unit(rng), unit(rng)));
  const auto round = extract_surfels(ball, {0, 0, 0});
  ASSERT_FALSE(flat.empty());
  ASSERT_EQ(round.size(), 1U);
  EXPECT_LT(round.front().flatness, 0.4F);
  for (const Surfel& s : flat) EXPECT_TRUE(s.count <= 50 || s.flatness > 0.8F) << s.count << ' ' << s.flatness;
}

TEST(Surfels, LonePointsMakeNone) {
  Cloud cloud;
  for (int i = 0; i < 500; ++i) cloud.points.emplace_back(static_cast<float>(i), 0.0F, 1.0F);
  EXPECT_TRUE(extract_surfels(cloud, {0, 0, 0}).empty());
  EXPECT_TRUE(extract_surfels({}, {0, 0, 0}).empty());
}

}  // namespace
}  // namespace liloc
