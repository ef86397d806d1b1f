#include "common/registration/points/voxel_mask.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace liloc {
namespace {

using Points = std::vector<Eigen::Vector3f>;

class VoxelMaskLaw : public testing::TestWithParam<unsigned> {
 protected:
  [[nodiscard]] Eigen::Vector3f anywhere() {
    std::uniform_real_distribution<float> unit(0, 1);
    return {8 * unit(rng_) - 1, 6 * unit(rng_), 2.5F * unit(rng_)};
  }
  [[nodiscard]] Points some() {
    Points points;
    for (int i = 0; i < 30; ++i) points.push_back(anywhere());
    return points;
  }
  static float distance(const Points& points, const Eigen::Vector3f& p) {
    float least = std::numeric_limits<float>::max();
    for (const Eigen::Vector3f& q : points) least = std::min(least, (p - q).norm());
    return least;
  }

 private:
  std::mt19937_64 rng_{GetParam()};
};

TEST_P(VoxelMaskLaw, ReachIsADistance) {
  const Points points = some();
  Points given = points;
  given.emplace_back(std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F);
  const VoxelMask mask(given, 0.3);
  constexpr float kBlur_m = 0.08F;  // a cell's half diagonal, and a little
  int inside = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3f p = anywhere();
    const float nearest = distance(points, p);
    ASSERT_TRUE(mask.at(p) || nearest > 0.3F - kBlur_m) << nearest;
    ASSERT_TRUE(!mask.at(p) || nearest < 0.3F + kBlur_m) << nearest;
    inside += mask.at(p);
  }
  EXPECT_GT(inside, 20);
}

TEST_P(VoxelMaskLaw, CoveringMissesNothingInReach) {
  const Points points = some();
  const VoxelMask mask = VoxelMask::covering(points, 0.3);
  int inside = 0, outside = 0;
  for (int i = 0; i < 5000; ++i) {
    const Eigen::Vector3f p = anywhere();
    const float nearest = distance(points, p);
    ASSERT_TRUE(mask.at(p) || nearest > 0.3F) << nearest;
    ASSERT_TRUE(!mask.at(p) || nearest < 0.3F + 0.14F) << nearest;
    ++(mask.at(p) ? inside : outside);
  }
  EXPECT_GT(inside, 100);
  EXPECT_GT(outside, 100);
}

TEST_P(VoxelMaskLaw, CoveringMissesNothingFarApartEither) {  // cells grow with the extent
  Points points = some();
  for (Eigen::Vector3f& p : points) p *= 100;
  const VoxelMask mask = VoxelMask::covering(points, 0.3);
  std::mt19937_64 rng(GetParam());
  std::uniform_real_distribution<float> unit(-1, 1);
  for (int i = 0; i < 1000; ++i) {
    const Eigen::Vector3f off(unit(rng), unit(rng), unit(rng));
    EXPECT_TRUE(mask.at(points[static_cast<std::size_t>(i) % points.size()] + 0.3F * off.normalized()));
  }
}

TEST_P(VoxelMaskLaw, ReachIsADistanceFarApartToo) {
  Points points = some();
  const std::size_t half = points.size() / 2;
  for (std::size_t i = 0; i < half; ++i) points[i] += Eigen::Vector3f(400, -300, 0);
  const VoxelMask mask(points, 0.3);
  std::mt19937_64 rng(GetParam());
  std::uniform_real_distribution<float> unit(-0.6F, 0.6F);
  int inside = 0, places = 0;
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3f p = points[rng() % points.size()] + Eigen::Vector3f(unit(rng), unit(rng), unit(rng));
    const float nearest = distance(points, p);
    ASSERT_TRUE(mask.at(p) || nearest > 0.3F - 0.08F) << nearest;
    ASSERT_TRUE(!mask.at(p) || nearest < 0.3F + 0.08F) << nearest;
    inside += mask.at(p);
  }
  EXPECT_GT(inside, 60);
  mask.for_each_place([&](const Eigen::Vector3f& p) { places += mask.at(p); });
  EXPECT_GT(places, 1000);
}

INSTANTIATE_TEST_SUITE_P(Seeds, VoxelMaskLaw, testing::Range(1U, 7U));

TEST(VoxelMask, OfNothingIsNowhere) {
  EXPECT_TRUE(VoxelMask().empty());
  EXPECT_TRUE(VoxelMask({}, 0.2).empty());
  EXPECT_FALSE(VoxelMask({}, 0.2).at(Eigen::Vector3f::Zero()));
  EXPECT_TRUE(VoxelMask::covering({}, 0.2).empty());
}

}  // namespace
}  // namespace liloc
