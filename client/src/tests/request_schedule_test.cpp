#include "client/src/request_schedule.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace liloc {
namespace {

constexpr StampNs kInterval = from_ms(800), kTimeout = from_ms(4000);

/// Stamps (ms) of the frames that were due, of frames 100 ms apart; those in `dull` say nothing.
std::vector<int> due_at(const std::vector<int>& dull, int frames) {
  RequestSchedule schedule(kInterval, kTimeout);
  std::vector<int> due;
  for (int i = 0; i < frames; ++i) {
    const bool informative = std::find(dull.begin(), dull.end(), i) == dull.end();
    if (schedule.due(from_ms(100.0 * i), informative)) due.push_back(100 * i);
  }
  return due;
}

TEST(RequestSchedule, TheFirstUsableFrameThenEveryInterval) {
  EXPECT_THAT(due_at({}, 25), testing::ElementsAre(0, 800, 1600, 2400));
  EXPECT_THAT(due_at({0, 1, 2}, 20), testing::ElementsAre(300, 1100, 1900));
}

TEST(RequestSchedule, AtOnceAfterADullStretchAndNeverWithinOne) {
  EXPECT_THAT(due_at({3, 4}, 16), testing::ElementsAre(0, 500, 1300));
  EXPECT_THAT(due_at({7, 8, 9, 10}, 20), testing::ElementsAre(0, 1100, 1900));
}

TEST(RequestSchedule, RoundedStampsDoNotMissTheInterval) {
  RequestSchedule schedule(kInterval, kTimeout);
  EXPECT_TRUE(schedule.due(1'000'000'256, true));
  EXPECT_TRUE(schedule.due(1'800'000'000, true));
}

TEST(RequestSchedule, UnansweredRequestsAreNamedOnce) {
  RequestSchedule schedule(kInterval, kTimeout);
  schedule.sent(1, from_ms(0));
  schedule.sent(2, from_ms(800));
  schedule.sent(3, from_ms(1600));
  schedule.answered(2);
  EXPECT_TRUE(schedule.take_unanswered(from_ms(3999)).empty());
  EXPECT_THAT(schedule.take_unanswered(from_ms(4000)), testing::ElementsAre(1U));
  EXPECT_THAT(schedule.take_unanswered(from_ms(9000)), testing::ElementsAre(3U));
  EXPECT_TRUE(schedule.take_unanswered(from_ms(20000)).empty());
}

}  // namespace
}  // namespace liloc
