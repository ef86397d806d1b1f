#include "server/app/remembered_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace liloc {
namespace {

using nlohmann::json;

Remembered some() {
  Remembered remembered;
  remembered.odom_segment = 7;
  Followed& f = remembered.followed;
  f.estimate.T_map_sensor = Eigen::Translation3d(3, 4, 1.2) * Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ());
  f.estimate.covariance = 1e-4 * Matrix6d::Identity();
  f.estimate.covariance(0, 5) = f.estimate.covariance(5, 0) = 2e-5;
  f.T_odom_sensor.translation() = Eigen::Vector3d(9, 8, 7);
  f.log_odds = 6.5;
  f.usual = {0.3, 1.2, 0.01, 0};
  return remembered;
}

Result<Remembered> read(const json& object) {
  return remembered_from(JsonFields(object, "here"));
}

TEST(RememberedJson, ComesBackAsItWas) {
  const auto again = read(json::parse(to_json(some()).dump()));
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->odom_segment, 7U);
  const Followed &now = again->followed, before = some().followed;
  EXPECT_TRUE(now.estimate.T_map_sensor.isApprox(before.estimate.T_map_sensor, 1e-9));
  EXPECT_TRUE(now.estimate.covariance.isApprox(before.estimate.covariance, 1e-12));
  EXPECT_TRUE(now.T_odom_sensor.isApprox(before.T_odom_sensor, 1e-9));
  EXPECT_DOUBLE_EQ(now.log_odds, before.log_odds);
  EXPECT_DOUBLE_EQ(now.usual.contradiction, before.usual.contradiction);
}

TEST(RememberedJson, WhatIsDamagedIsNamed) {
  for (const auto& [path, value, says] : std::initializer_list<std::tuple<const char*, json, const char*>>{
           {"/odom_segment", -1, "here.odom_segment"},
           {"/T_map_sensor", "here", "here.T_map_sensor"},
           {"/T_odom_sensor/rotation_xyzw/0", 5, "here.T_odom_sensor"},
           {"/covariance/0", -1e-4, "here.covariance is no covariance"},
           {"/covariance/1", 1e-4, "here.covariance is no covariance"},
           {"/covariance/0", nullptr, "here.covariance is no covariance"},
           {"/covariance", json::array({1}), "here.covariance is no list of 36 numbers"},
           {"/log_odds", 1e300, "here.log_odds"},
           {"/usual", 3, "here.usual is missing"},
           {"/usual/excess", "much", "here.usual.excess"}}) {
    json object = json::parse(to_json(some()).dump());
    object[json::json_pointer(path)] = value;
    const auto damaged = read(object);
    ASSERT_FALSE(damaged) << path;
    EXPECT_THAT(damaged.error().message, testing::HasSubstr(says));
  }
}

}  // namespace
}  // namespace liloc
