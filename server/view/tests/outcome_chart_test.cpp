#include "server/view/outcome_chart.hpp"

#include <gtest/gtest.h>

#include <numeric>

namespace liloc::view {
namespace {

using namespace std::chrono_literals;

constexpr OutcomeChart::Time kStart{std::chrono::hours(1)};

TEST(OutcomeChart, CountsByOutcomeAndColumn) {
  OutcomeChart chart;
  chart.add(kStart, SpotStatus::verified, 4);
  chart.add(kStart + 1s, SpotStatus::refused, 4);
  chart.add(kStart + 6s, SpotStatus::provisional, 4);
  const auto columns = chart.columns(kStart + 6s);
  ASSERT_EQ(columns.size(), static_cast<std::size_t>(kColumns));
  const ChartColumn &before = columns[kColumns - 2], &last = columns[kColumns - 1];
  EXPECT_EQ(std::tuple(before.verified, before.provisional, before.refused), std::tuple(1U, 0U, 1U));
  EXPECT_EQ(std::tuple(last.verified, last.provisional, last.refused), std::tuple(0U, 1U, 0U));
  EXPECT_FALSE(columns.front().median_ms);
}

TEST(OutcomeChart, QuantilesAreWithinTenPerCent) {
  for (const double latency_ms : {0.3, 4.0, 33.0, 700.0, 4000.0}) {
    OutcomeChart chart;
    for (int i = 0; i < 90; ++i) chart.add(kStart, SpotStatus::verified, latency_ms);
    for (int i = 0; i < 10; ++i) chart.add(kStart, SpotStatus::verified, 3 * latency_ms);
    const auto last = chart.columns(kStart).back();
    EXPECT_NEAR(*last.median_ms, latency_ms, 0.1 * latency_ms);
    EXPECT_NEAR(*last.p95_ms, 3 * latency_ms, 0.1 * 3 * latency_ms);
  }
}

TEST(OutcomeChart, LatenciesOfNoSenseDoNoHarm) {
  OutcomeChart chart;
  for (const double latency_ms : {-1.0, 0.0, 1e12, std::numeric_limits<double>::quiet_NaN()})
    chart.add(kStart, SpotStatus::refused, latency_ms);
  const auto last = chart.columns(kStart).back();
  EXPECT_EQ(last.refused, 4U);
  EXPECT_LT(*last.p95_ms, 20'000);
}

TEST(OutcomeChart, WhatIsOverTenMinutesOldIsGone) {
  OutcomeChart chart;
  chart.add(kStart, SpotStatus::verified, 4);
  const auto sum = [&](OutcomeChart::Time now) {
    const auto columns = chart.columns(now);
    return std::accumulate(columns.begin(), columns.end(), 0U,
                           [](unsigned all, const ChartColumn& c) { return all + c.verified; });
  };
  EXPECT_EQ(sum(kStart + kColumn * (kColumns - 1)), 1U);
  EXPECT_EQ(sum(kStart + kColumn * kColumns), 0U);
  chart.add(kStart + 2 * kColumn * kColumns, SpotStatus::verified, 4);
  EXPECT_EQ(sum(kStart + 2 * kColumn * kColumns), 1U);
}

}  // namespace
}  // namespace liloc::view
