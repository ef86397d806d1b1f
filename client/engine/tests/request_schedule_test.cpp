#include "client/engine/request_schedule.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

namespace liloc {
namespace {

using testing::ElementsAre;

constexpr RequestScheduleOptions kOptions{from_ms(800), 0, from_ms(4000)};

/// Stamps (ms) of the frames that were due, of frames 100 ms apart; those in `dull` say nothing.
std::vector<int> due_at(const std::vector<int>& dull, int frames) {
  RequestSchedule schedule(kOptions);
  std::vector<int> due;
  for (int i = 0; i < frames; ++i) {
    const bool informative = std::find(dull.begin(), dull.end(), i) == dull.end();
    if (schedule.due(from_ms(100.0 * i), informative)) due.push_back(100 * i);
  }
  return due;
}

SpotReply reply_to(std::uint64_t seq, SpotStatus status, Reason reason) {
  SpotReply reply;
  reply.seq = seq;
  reply.status = status;
  reply.reason = reason;
  return reply;
}

/// A device that gets the same answer to everything, so long after it asked; 0 ms: before its next frame.
struct Exchange {
  SpotStatus status = SpotStatus::provisional;
  Reason reason = Reason::awaiting_spots;
  int takes_ms = 0;
  int until_ms = 1'000'000;  ///< requests after this are not answered
  RequestScheduleOptions options = kOptions;
  std::function<void(RequestSchedule&, int at_ms)> before_frame = [](RequestSchedule&, int) {};

  /// Stamps (ms) of its requests.
  [[nodiscard]] std::vector<int> asks(int last_ms) const {
    RequestSchedule schedule(options);
    std::vector<int> due;
    std::size_t answered = 0;
    for (int ms = 0; ms <= last_ms; ms += 100) {
      before_frame(schedule, ms);
      if (schedule.due(from_ms(ms), true)) {
        schedule.sent(due.size(), from_ms(ms));
        due.push_back(ms);
      }
      for (; answered < due.size() && due[answered] <= until_ms && ms >= due[answered] + takes_ms; ++answered)
        schedule.answered(reply_to(answered, status, reason), from_ms(ms));
    }
    return due;
  }
};

TEST(RequestSchedule, TheFirstUsableFrameThenEveryInterval) {
  EXPECT_THAT(due_at({}, 25), ElementsAre(0, 800, 1600, 2400));
  EXPECT_THAT(due_at({0, 1, 2}, 20), ElementsAre(300, 1100, 1900));
}

TEST(RequestSchedule, AtOnceAfterADullStretchAndNeverWithinOne) {
  EXPECT_THAT(due_at({3, 4}, 16), ElementsAre(0, 500, 1300));
  EXPECT_THAT(due_at({7, 8, 9, 10}, 20), ElementsAre(0, 1100, 1900));
}

TEST(RequestSchedule, FramesThatFlickerDoNotAskMoreOftenThanTheLowerBound) {
  RequestSchedule schedule(kOptions);
  std::vector<int> due;
  for (int ms = 0; ms <= 1000; ms += 50)
    if (schedule.due(from_ms(ms), ms % 100 == 0)) due.push_back(ms);
  EXPECT_THAT(due, ElementsAre(0, 200, 400, 600, 800, 1000));
}

TEST(RequestSchedule, AtOnceWhenThePlaceIsSureAgainButForTheLowerBound) {
  const auto due_with_doubt = [](int first_ms, int last_ms) {
    RequestSchedule schedule(kOptions);
    std::vector<int> due;
    for (int ms = 0; ms <= 1600; ms += 100)
      if (schedule.due(from_ms(ms), true, ms < first_ms || ms > last_ms)) due.push_back(ms);
    return due;
  };
  EXPECT_THAT(due_with_doubt(9000, 9000), ElementsAre(0, 800, 1600));
  EXPECT_THAT(due_with_doubt(300, 400), ElementsAre(0, 500, 1300));
  EXPECT_THAT(due_with_doubt(100, 100), ElementsAre(0, 200, 1000));
  EXPECT_THAT(due_with_doubt(800, 800), ElementsAre(0, 800, 1000));   // 900 would be too soon
  EXPECT_THAT(due_with_doubt(100, 1200), ElementsAre(0, 800, 1300));  // as usual meanwhile
}

TEST(RequestSchedule, AServerThatComesIsAskedAtOnceAndQuicklyUntilItVerifies) {
  Exchange exchange{.status = SpotStatus::verified, .reason = Reason::confirmed};
  exchange.before_frame = [](RequestSchedule& schedule, int at_ms) {
    schedule.search_ended();
    if (at_ms == 1100) schedule.server_found();
  };
  EXPECT_THAT(exchange.asks(3000), ElementsAre(0, 800, 1100, 1900, 2700));
  exchange.status = SpotStatus::provisional;  // it has to look first
  exchange.reason = Reason::awaiting_spots;
  EXPECT_THAT(exchange.asks(1900), ElementsAre(0, 800, 1100, 1300, 1500, 1700, 1900));
  exchange.before_frame = [](RequestSchedule& schedule, int at_ms) {
    if (at_ms == 100) schedule.server_found();
  };
  EXPECT_THAT(exchange.asks(300), ElementsAre(0, 200)) << "not under the lower bound";
}

TEST(RequestSchedule, RoundedStampsDoNotMissTheInterval) {
  RequestSchedule schedule(kOptions);
  EXPECT_TRUE(schedule.due(1'000'000'256, true));
  EXPECT_TRUE(schedule.due(1'800'000'000, true));
}

TEST(RequestSchedule, WhileNothingIsVerifiedAnAnswerBringsTheNextRequestForward) {
  EXPECT_THAT(Exchange{}.asks(4000), ElementsAre(0, 200, 400, 600, 800, 1200, 2000, 2800, 3600));
  for (const Reason reason : {Reason::not_found, Reason::no_gpc}) {
    const Exchange refused{.status = SpotStatus::refused, .reason = reason};
    EXPECT_THAT(refused.asks(800), ElementsAre(0, 200, 400, 600, 800));
  }
}

TEST(RequestSchedule, TheLowerBoundIsAnOption) {
  Exchange exchange;
  exchange.options.searching_interval_ns = from_ms(300);
  EXPECT_THAT(exchange.asks(1600), ElementsAre(0, 300, 600, 900, 1500));
  exchange.options.searching_interval_ns = exchange.options.interval_ns;
  EXPECT_THAT(exchange.asks(1600), ElementsAre(0, 800, 1600));
}

TEST(RequestSchedule, ASlowServerIsAskedAtMostHalfOfTheTime) {
  EXPECT_THAT(Exchange{.takes_ms = 200}.asks(1600), ElementsAre(0, 400, 800, 1600));
  EXPECT_THAT(Exchange{.takes_ms = 600}.asks(1600), ElementsAre(0, 800, 1600));
}

TEST(RequestSchedule, ASilentOrBusyServerIsAskedEveryInterval) {
  EXPECT_THAT(Exchange{.until_ms = 200}.asks(2000), ElementsAre(0, 200, 400, 1200, 2000));
  for (const Reason busy :
       {Reason::overloaded, Reason::superseded, Reason::rate_limit, Reason::shutting_down}) {
    const Exchange refused{.status = SpotStatus::refused, .reason = busy};
    EXPECT_THAT(refused.asks(1600), ElementsAre(0, 800, 1600)) << name_of(busy);
  }
}

TEST(RequestSchedule, NoHasteOnceAnAnswerIsVerified) {
  Exchange exchange;
  exchange.before_frame = [](RequestSchedule& schedule, int at_ms) {
    if (at_ms == 300) schedule.search_ended();
  };
  EXPECT_THAT(exchange.asks(1800), ElementsAre(0, 200, 1000, 1800));
}

TEST(RequestSchedule, ABreakOfTheOdometryBeginsAnotherSearch) {
  Exchange exchange;
  exchange.before_frame = [](RequestSchedule& schedule, int at_ms) {
    if (at_ms == 100) schedule.search_ended();
    if (at_ms == 1000) schedule.search_begins();  // the answer to the request at 800 came before
  };
  EXPECT_THAT(exchange.asks(2800), ElementsAre(0, 800, 1000, 1200, 1400, 1600, 1800, 2200));
}

TEST(RequestSchedule, UnansweredRequestsAreNamedOnce) {
  RequestSchedule schedule(kOptions);
  schedule.sent(1, from_ms(0));
  schedule.sent(2, from_ms(800));
  schedule.sent(3, from_ms(1600));
  EXPECT_TRUE(schedule.due(from_ms(1600), true));
  schedule.answered(reply_to(2, SpotStatus::verified, Reason::confirmed), from_ms(1700));
  EXPECT_TRUE(schedule.take_unanswered(from_ms(3999)).empty());
  EXPECT_THAT(schedule.take_unanswered(from_ms(4000)), ElementsAre(1U));
  EXPECT_THAT(schedule.take_unanswered(from_ms(9000)), ElementsAre(3U));
  EXPECT_TRUE(schedule.take_unanswered(from_ms(20000)).empty());
}

}  // namespace
}  // namespace liloc
