#include "proto-tests/load/plan.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

namespace liloc::load {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

LoadOptions options(double seconds) {
  LoadOptions o;
  o.seconds = seconds;
  return o;
}

TEST(LoadPlan, WhoStaysComesInTheWarmUpAtATimeOfItsOwn) {
  const auto plans = draw_plans(options(20), 50, 6);
  ASSERT_EQ(plans.size(), 50U);
  std::set<double> starts;
  for (const DevicePlan& plan : plans) {
    EXPECT_LT(plan.start_s, LoadOptions::warmup_s(50));
    EXPECT_EQ(plan.end_s, LoadOptions::warmup_s(50) + 20);
    EXPECT_LT(plan.path, 6U);
    starts.insert(plan.start_s);
  }
  EXPECT_EQ(starts.size(), 50U);
}

TEST(LoadPlan, InPhaseAllStartAtOnce) {
  LoadOptions o = options(20);
  o.in_phase = true;
  for (const DevicePlan& plan : draw_plans(o, 10, 1)) EXPECT_EQ(plan.start_s, 0);
}

TEST(LoadPlan, WhereDevicesComeAndGoAsManyAreThere) {
  LoadOptions o = options(60);
  o.churn_s = 5;
  const auto plans = draw_plans(o, 10, 3);
  EXPECT_GT(plans.size(), 60U);
  const double middle_s = LoadOptions::warmup_s(10) + 30;
  std::set<std::string> ids;
  int there = 0;
  for (const DevicePlan& plan : plans) {
    EXPECT_TRUE(ids.insert(plan.id).second) << plan.id;
    if (plan.start_s <= middle_s && middle_s < plan.end_s) ++there;
  }
  EXPECT_EQ(there, 10);
}

TEST(LoadPlan, AShareOfTheDevicesLosesItsWayAtOneMoment) {
  LoadOptions o = options(40);
  o.lost_share = 0.2;
  o.kidnap_s = 10;
  std::set<double> lost_at;
  std::size_t lost = 0, kidnaps = 0;
  for (const DevicePlan& plan : draw_plans(o, 20, 3)) {
    if (std::isfinite(plan.lost_at_s)) ++lost, lost_at.insert(plan.lost_at_s);
    kidnaps += plan.kidnaps_s.size();
    EXPECT_TRUE(std::ranges::is_sorted(plan.kidnaps_s));
  }
  EXPECT_EQ(lost, 4U);
  EXPECT_EQ(lost_at.size(), 1U);
  EXPECT_GT(kidnaps, 40U);
}

TEST(LoadPlan, TheSameSeedDrawsTheSame) {
  LoadOptions o = options(20);
  EXPECT_EQ(draw_plans(o, 3, 6)[2].clock_offset_s, draw_plans(o, 5, 6)[2].clock_offset_s);
  const double clock_offset_s = draw_plans(o, 3, 6)[2].clock_offset_s;
  o.seed = 8;
  EXPECT_NE(draw_plans(o, 3, 6)[2].clock_offset_s, clock_offset_s);
}

TEST(LoadOptions, ARampRunsFromItsFirstToItsLast) {
  EXPECT_THAT(*ramp_of("1:400"), ElementsAre(1, 2, 5, 10, 20, 50, 100, 200, 400));
  EXPECT_THAT(*ramp_of("8:30"), ElementsAre(8, 10, 20, 30));
  EXPECT_THAT(*ramp_of("10:10"), ElementsAre(10));
  for (const char* bad : {"", "1", "1:", ":4", "4:1", "0:4", "1:4000", "1:4x", "nan:2"}) {
    const auto ramp = ramp_of(bad);
    ASSERT_FALSE(ramp) << bad;
    EXPECT_THAT(ramp.error().message, HasSubstr("--ramp")) << bad;
  }
}

TEST(LoadOptions, WhatIsOutOfRangeIsNamed) {
  const auto refused = [](auto change) {
    LoadOptions o;
    change(o);
    const Status status = o.validated();
    return status ? std::string() : status.error().message;
  };
  EXPECT_THAT(refused([](auto& o) { o.clients = {5, 2000}; }), HasSubstr("--clients is 2000"));
  EXPECT_THAT(refused([](auto& o) { o.clients = {}; }), HasSubstr("--clients"));
  EXPECT_THAT(refused([](auto& o) { o.seconds = std::nan(""); }), HasSubstr("--seconds"));
  EXPECT_THAT(refused([](auto& o) { o.churn_s = 0.5; }), HasSubstr("--churn"));
  EXPECT_THAT(refused([](auto& o) { o.kidnap_s = 0.5; }), HasSubstr("--kidnap"));
  EXPECT_THAT(refused([](auto& o) { o.server = "edge"; }), HasSubstr("--domain"));
  EXPECT_THAT(refused([](auto& o) { o.domain = 3, o.freeze_s = 2; }), HasSubstr("--freeze"));
  EXPECT_THAT(refused([](auto& o) { o.domain = 3, o.server_options = {"--workers=2"}; }),
              HasSubstr("--server-option"));
  EXPECT_EQ(refused([](auto&) {}), "");
}

}  // namespace
}  // namespace liloc::load
