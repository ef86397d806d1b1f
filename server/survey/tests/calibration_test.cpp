#include "server/survey/calibration.hpp"

#include <gtest/gtest.h>

#include "server/survey/tests/ceiling.hpp"

namespace liloc::survey {
namespace {

/// Points that belong to no room, as a LiDAR in fog may see.
Cloud fog(unsigned seed) {
  std::mt19937 rng(seed);
  std::uniform_real_distribution<float> side(-1.5F, 1.5F), depth(1, 4);
  std::normal_distribution<float> unit(0, 1);
  Cloud cloud;
  for (int i = 0; i < 3000; ++i) {
    cloud.points.emplace_back(side(rng), side(rng), depth(rng));
    Eigen::Vector3f normal = Eigen::Vector3f(unit(rng), unit(rng), unit(rng)).normalized();
    if (normal.dot(cloud.points.back()) > 0) normal = -normal;
    cloud.normals.push_back(normal);
  }
  return cloud;
}

class CalibrationLaw : public testing::TestWithParam<unsigned> {
 protected:
  /// Scans whose site is off by 5 cm and 3 degrees, but for the first.
  [[nodiscard]] std::vector<LidarScan> guessed() const {
    auto all = test::scans(GetParam());
    for (std::size_t i = 1; i < all.size(); ++i)
      all[i].lidar.T_map_sensor =
          test::disturbed(all[i].lidar.T_map_sensor, GetParam() + static_cast<unsigned>(i), 0.05, radians(3));
    return all;
  }
};

TEST_P(CalibrationLaw, WhoIsTrustedIsRight) {
  const auto results = calibrate(guessed(), nullptr, {{false, false, false}}).value();
  for (std::size_t i = 0; i < results.size(); ++i) {
    if (results[i].trusted()) {
      EXPECT_LT(distance_m(results[i].T_map_sensor, test::hung()[i]), 0.02) << i;
    }
  }
}

TEST_P(CalibrationLaw, OneInFogIsDoubtedAndMovesNobody) {
  auto with = guessed();
  const auto without = calibrate({with[0], with[1]}, nullptr, {{false, false}}).value();
  with[2].cloud = fog(GetParam());
  const auto results = calibrate(with, nullptr, {{false, false, false}}).value();
  EXPECT_FALSE(results[2].trusted());
  EXPECT_LT(distance_m(results[1].T_map_sensor, without[1].T_map_sensor), 0.005);
}

TEST_P(CalibrationLaw, WhomNobodyCanJudgeStaysWhereHeIsAndIsNotTrusted) {
  auto all = test::scans(GetParam());
  all.resize(2);
  all[0].lidar.T_map_sensor = test::hung()[0];
  all[1].cloud = fog(GetParam());
  const auto results = calibrate(all, nullptr, {{false, true}}).value();
  ASSERT_EQ(results.size(), 2U);
  for (const CalibratedLidar& result : results) EXPECT_FALSE(result.trusted());
  EXPECT_TRUE(results[0].T_map_sensor.isApprox(all[0].lidar.T_map_sensor, 1e-9));
}

INSTANTIATE_TEST_SUITE_P(Seeds, CalibrationLaw, testing::Range(1U, 3U));

}  // namespace
}  // namespace liloc::survey
