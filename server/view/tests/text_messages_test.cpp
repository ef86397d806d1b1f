#include "server/view/text_messages.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace liloc::view {
namespace {

using nlohmann::json;

const auto kNow = std::chrono::steady_clock::now();

std::shared_ptr<DeviceState> device() {
  auto made = std::make_shared<DeviceState>();
  made->last.client_id = "robot1";
  made->last.reason = Reason::not_found;
  made->last.advice = Advice::turn_around;
  made->last.text = "nothing fits";
  made->at = kNow;
  return made;
}

TEST(TextMessages, ASiteTellsWhereItsLidarsHangAndLook) {
  Site site;
  Pose T = Pose::Identity();
  T.translation() = Eigen::Vector3d(1, 2, 3);
  site.global_lidars = {{"c0", {64, 48, 32, 24, 32, 24, 0.001}, 10, T}};
  web::ServerFacts facts;
  facts.server_id = "edge1";
  const auto told = json::parse(site_message(site, facts));
  EXPECT_EQ(told["part"], "site");
  EXPECT_EQ(told["server"], "edge1");
  EXPECT_EQ(told["lidars"][0]["pose"], json({1.0, 2.0, 3.0, 0.0, 0.0, 0.0, 1.0}));
  EXPECT_EQ(told["lidars"][0]["view"], json({-1.0, 1.0, -1.0, 1.0}));
}

TEST(TextMessages, NowTellsEachLidarAndDevice) {
  web::ServerFacts facts;
  facts.lidars.resize(2);
  facts.lidars[0].health.state = wire::LidarState::slow;
  facts.lidars[0].health.measured_hz = 4.9;
  facts.lidars[0].age_s = 0.2;
  const auto told = json::parse(now_message(facts, {device()}, kNow + std::chrono::seconds(2)));
  EXPECT_EQ(told["lidars"][0]["state"], "slow");
  EXPECT_EQ(told["lidars"][0]["age_s"], 0.2);
  EXPECT_TRUE(told["lidars"][1]["age_s"].is_null());
  const auto& lost = told["devices"][0];
  EXPECT_EQ(lost["reason"], "not_found");
  EXPECT_EQ(lost["advice"], "turn_around");
  EXPECT_EQ(lost["text"], "nothing fits");
  EXPECT_EQ(lost["age_s"], 2.0);
  EXPECT_TRUE(lost["pose"].is_null());
  EXPECT_TRUE(lost["scan"].is_null());
}

TEST(TextMessages, UncertaintyIsToldInTheMapFrame) {
  const auto known = device();
  known->T_map_sensor = Pose(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  known->covariance.diagonal() << 1, 1, 1, 0.09, 1e-4, 1e-4;  // 30 cm along the sensor's x: the map's y
  const auto told = json::parse(now_message({}, {known}, kNow));
  const auto axes = told["devices"][0]["axes"].get<std::vector<double>>();
  ASSERT_EQ(axes.size(), 9U);
  EXPECT_NEAR(std::abs(axes[7]), 0.3, 1e-3);  // the longest comes last
  EXPECT_NEAR(axes[6], 0, 1e-3);
  known->covariance(3, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(json::parse(now_message({}, {known}, kNow))["devices"][0]["axes"].empty());
}

TEST(TextMessages, WhatIsNoNumberIsNull) {
  const auto odd = device();
  odd->confidence = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(json::parse(now_message({}, {odd}, kNow))["devices"][0]["confidence"].is_null());
}

TEST(TextMessages, TrailsAreInCentimetres) {
  const auto known = device();
  known->trail_map = {{1.234F, -0.5F, 0}, {2, 0, 1}};
  EXPECT_EQ(json::parse(trails_message({known}))["of"]["robot1"], json({123, -50, 0, 200, 0, 100}));
}

TEST(TextMessages, ChartsTellEachColumn) {
  const auto told = json::parse(charts_message({{1, 2, 3, 4.5, 6.5}, {}}));
  EXPECT_EQ(told["refused"], json({3, 0}));
  EXPECT_EQ(told["median_ms"], json({4.5, nullptr}));
  EXPECT_EQ(told["column_s"], 5);
}

TEST(TextMessages, ALogLineThatIsNoUtf8IsStillJson) {
  const LogLine line{std::chrono::system_clock::time_point(std::chrono::milliseconds(1500)),
                     log::Level::warning, "\xff<script>"};
  const auto told = json::parse(log_message({line}));
  EXPECT_EQ(told["lines"][0][0], 1500);
  EXPECT_EQ(told["lines"][0][1], "warning");
  EXPECT_EQ(told["lines"][0][2], "\xef\xbf\xbd<script>");
}

}  // namespace
}  // namespace liloc::view
