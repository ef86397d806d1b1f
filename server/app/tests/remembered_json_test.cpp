#include "server/app/remembered_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "server/app/tests/remembered_device.hpp"

namespace liloc {
namespace {

using nlohmann::json;

Result<Remembered> read(const json& object) {
  return remembered_from(JsonFields(object, "here"));
}

TEST(RememberedJson, ComesBackAsItWas) {
  const auto again = read(json::parse(to_json(test::remembered_device()).dump()));
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->odom_segment, 7U);
  const Followed &now = again->followed, before = test::remembered_device().followed;
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
    json object = json::parse(to_json(test::remembered_device()).dump());
    object[json::json_pointer(path)] = value;
    const auto damaged = read(object);
    ASSERT_FALSE(damaged) << path;
    EXPECT_THAT(damaged.error().message, testing::HasSubstr(says));
  }
}

}  // namespace
}  // namespace liloc
