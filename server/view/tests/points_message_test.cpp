#include "server/view/points_message.hpp"

#include <array>
#include <limits>
#include <random>

#include "server/view/tests/points.hpp"

namespace liloc::view {
namespace {

std::string message(const std::vector<Cloud>& clouds, Points kind = Points::room) {
  std::vector<const Cloud*> all;
  for (const Cloud& cloud : clouds) all.push_back(&cloud);
  return points_message(kind, all);
}

TEST(PointsMessage, TellsA20MetreRoomToAThirdOfAMillimetre) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-10, 10);
  std::vector<Cloud> clouds(2);
  for (int i = 0; i < 2000; ++i)
    clouds[i % 2].points.emplace_back(place(random), place(random), 0.1F * place(random));
  const auto read = test::read_points(message(clouds, Points::moving));
  EXPECT_EQ(read.kind, 2);
  ASSERT_EQ(read.points_map.size(), 2000U);
  for (std::size_t i = 0; i < 1000; ++i) {
    EXPECT_LT((read.points_map[i] - clouds[0].points[i]).norm(), 0.0003F);
    EXPECT_LT((read.points_map[1000 + i] - clouds[1].points[i]).norm(), 0.0003F);
  }
}

TEST(PointsMessage, LeavesOutWhatIsNotFinite) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const auto read = test::read_points(message({{{{1, 2, 3}, {nan, 0, 0}, {0, inf, 0}, {4, 5, 6}}, {}}}));
  ASSERT_EQ(read.points_map.size(), 2U);
  EXPECT_LT((read.points_map[1] - Eigen::Vector3f(4, 5, 6)).norm(), 1e-3F);
}

TEST(PointsMessage, EmptyFlatAndSinglePointsAreTold) {
  EXPECT_TRUE(test::read_points(message({})).points_map.empty());
  EXPECT_TRUE(test::read_points(message({Cloud{}})).points_map.empty());
  const auto flat = test::read_points(message({{{{-3, -3, 1}, {3, 3, 1}}, {}}}));
  for (const auto& p : flat.points_map) EXPECT_NEAR(p.z(), 1, 1e-3);
  EXPECT_LT(
      (test::read_points(message({{{{7, 8, 9}}, {}}})).points_map.at(0) - Eigen::Vector3f(7, 8, 9)).norm(),
      1e-3F);
}

TEST(PointsMessage, ThinsWhatIsTooMuch) {
  Cloud large;
  for (std::size_t i = 0; i < 2 * kMostPoints + 5; ++i)
    large.points.emplace_back(static_cast<float>(i), 0.0F, 0.0F);
  const auto read = test::read_points(message({large}));
  EXPECT_LE(read.points_map.size(), kMostPoints);
  EXPECT_GT(read.points_map.size(), kMostPoints / 2);
}

}  // namespace
}  // namespace liloc::view
