#include "client/session/frame_budget.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

/// Share of the frames that are processed where each takes so long.
double processed(double cpu_share, double hz, double wall_ms, double cpu_ms) {
  FrameBudget budget(cpu_share);
  int taken = 0, counted = 0;
  for (int i = 0; i < 600; ++i) {
    const bool admitted = budget.admit(from_seconds(1 + i / hz));
    if (i >= 100) {
      ++counted;
      taken += admitted;
    }
    if (admitted) budget.spent(wall_ms, cpu_ms);
  }
  return static_cast<double>(taken) / counted;
}

TEST(FrameBudget, AllFramesWhereTheyFit) {
  EXPECT_DOUBLE_EQ(processed(1, 15, 5, 5), 1);
  EXPECT_DOUBLE_EQ(processed(1, 60, 14, 14), 1);
}

TEST(FrameBudget, EvenlyFewerWhereTheyWouldQueue) {
  EXPECT_NEAR(processed(1, 30, 60, 60), 0.5, 0.01);   // 33 ms apart
  EXPECT_NEAR(processed(1, 60, 60, 60), 0.25, 0.01);  // 17 ms apart
}

TEST(FrameBudget, ASmallShareOfTheCpuIsKept) {
  const double share = processed(0.1, 30, 5, 5);
  EXPECT_LE(share * 30 * 5e-3, 0.1 / 0.9);
  EXPECT_GT(share, 0.45);
}

TEST(FrameBudget, OneDearFrameIsNoTrend) {
  FrameBudget budget(1);
  for (int i = 0; i < 20; ++i) {
    EXPECT_TRUE(budget.admit(from_ms(66.0 * i)));
    budget.spent(i == 10 ? 400 : 5, 5);
  }
}

TEST(FrameBudget, AdaptsWhenTheComputerIsFreeAgain) {
  FrameBudget budget(1);
  int last_taken = 0;
  for (int i = 0; i < 300; ++i) {
    if (!budget.admit(from_ms(33.3 * i))) continue;
    budget.spent(i < 100 ? 100 : 5, 5);
    last_taken = i;
  }
  EXPECT_EQ(last_taken, 299);
  EXPECT_LT(budget.interval_ms(), 10);
}

TEST(FrameBudget, ThreadTimeRunsWithWork) {
  const double before = thread_cpu_ms();
  volatile double sum = 0;
  for (int i = 0; i < 3'000'000; ++i) sum = sum + i;
  EXPECT_GT(thread_cpu_ms(), before);
}

TEST(FrameBudget, IsKeptAfterTheClockWasSetBack) {
  FrameBudget budget(1);
  for (int i = 0; i < 10; ++i) budget.spent(100, 100);
  ASSERT_TRUE(budget.admit(from_seconds(100)));
  int admitted = 0;
  for (int i = 0; i < 100; ++i) admitted += budget.admit(from_seconds(80) + from_ms(10.0 * i));
  EXPECT_LE(admitted, 12);  // of a second
}

}  // namespace
}  // namespace liloc
