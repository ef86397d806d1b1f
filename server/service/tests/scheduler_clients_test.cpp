#include <gtest/gtest.h>

#include <atomic>
#include <set>

#include "common/base/log.hpp"
#include "server/service/tests/answers.hpp"

namespace liloc {
namespace {

using namespace std::chrono_literals;
using namespace test;

TEST(SchedulerClients, ARequestNoNewerThanTheLastAnswerIsLate) {
  Answers answers;
  RequestScheduler scheduler({}, {.locate = verified}, answers.sink());
  scheduler.submit(arrival("a", 5));
  ASSERT_TRUE(answers.wait_for(1));
  scheduler.submit(arrival("a", 4));
  EXPECT_EQ(answers.reason("a", 4), Reason::late);
}

wire::Arrival from_writer(std::uint64_t publication, const std::string& client, std::uint64_t seq) {
  wire::Arrival a = arrival(client, seq);
  a.from.publication = publication;
  return a;
}

TEST(SchedulerClients, AForeignWritersLargeSeqMakesNobodyLate) {
  Answers answers;
  RequestScheduler scheduler({}, {.locate = verified}, answers.sink());
  scheduler.submit(from_writer(1, "a", 5));
  ASSERT_TRUE(answers.wait_for(1));
  scheduler.submit(from_writer(2, "a", 1'000'000));  // the same session: it was read off the wire
  ASSERT_TRUE(answers.wait_for(2));
  for (std::uint64_t seq = 6; seq < 9; ++seq) scheduler.submit(from_writer(1, "a", seq));
  ASSERT_TRUE(answers.wait_for(5));
  EXPECT_EQ(answers.reason("a", 8), Reason::confirmed);
  scheduler.submit(from_writer(1, "a", 8));
  EXPECT_EQ(answers.reason("a", 8), Reason::late) << "its own order still counts";
}

TEST(SchedulerClients, TwoDevicesOfOneIdAreToldInTheLog) {
  std::vector<std::string> lines;
  log::set_sink([&](log::Level level, std::string_view line) {
    if (level == log::Level::warning) lines.emplace_back(line);
  });
  {
    Answers answers;
    RequestScheduler scheduler({}, {.locate = verified}, answers.sink());
    for (std::uint64_t i = 0; i < 10; ++i) {
      scheduler.submit(from_writer(1 + i % 2, "twin", 1 + i));
      ASSERT_TRUE(answers.wait_for(i + 1));
    }
    scheduler.submit(arrival("other", 1));
  }
  log::set_sink({});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NE(lines[0].find("two devices ask as twin"), std::string::npos) << lines[0];
}

TEST(SchedulerClients, ARestartIsNoSecondDevice) {
  std::vector<std::string> lines;
  log::set_sink([&](log::Level level, std::string_view line) {
    if (level == log::Level::warning) lines.emplace_back(line);
  });
  {
    Answers answers;
    RequestScheduler scheduler({}, {.locate = verified}, answers.sink());
    for (std::uint64_t run = 1; run < 5; ++run) {
      scheduler.submit(from_writer(run, "a", 1));
      ASSERT_TRUE(answers.wait_for(run));
    }
  }
  log::set_sink({});
  EXPECT_TRUE(lines.empty()) << lines[0];
}

TEST(SchedulerClients, ARestartedClientBeginsAnewAndIsForgotten) {
  Answers answers;
  std::atomic<int> forgotten = 0;
  RequestScheduler scheduler({}, {.locate = verified, .forget = [&](const std::string&) { ++forgotten; }},
                             answers.sink());
  scheduler.submit(arrival("a", 5, 1));
  ASSERT_TRUE(answers.wait_for(1));
  scheduler.submit(arrival("a", 1, 2));
  ASSERT_TRUE(answers.wait_for(2));
  EXPECT_EQ(answers.reason("a", 1), Reason::confirmed);
  EXPECT_EQ(forgotten, 1);
  scheduler.client_left("a");
  EXPECT_EQ(forgotten, 2);
}

TEST(SchedulerClients, AFloodIsLimitedPerClient) {
  Answers answers;
  RequestScheduler scheduler({.max_rate_hz = 1}, {.locate = verified}, answers.sink());
  for (std::uint64_t seq = 1; seq <= 50; ++seq) scheduler.submit(arrival("flood", seq));
  scheduler.submit(arrival("calm", 1));
  ASSERT_TRUE(answers.wait_for(51));
  EXPECT_EQ(answers.reason("flood", 50), Reason::rate_limit);
  EXPECT_EQ(answers.reason("calm", 1), Reason::confirmed);
  answers.expect_each_once(51);
}

TEST(SchedulerClients, AFloodIsLimitedPerIdentityHoweverManyWritersItHas) {
  Answers answers;
  RequestScheduler scheduler({.max_rate_hz = 5}, {.locate = verified}, answers.sink());
  for (std::uint64_t writer = 1; writer <= 50; ++writer) {
    auto one = arrival("flood", writer);
    one.from.publication = writer;
    scheduler.submit(std::move(one));
  }
  ASSERT_TRUE(answers.wait_for(50));
  EXPECT_EQ(answers.count(Reason::rate_limit), 45U);
}

TEST(SchedulerClients, OneClientKeepsOneWorkerAtMost) {
  Gate gate;
  Answers answers;
  RequestScheduler scheduler(
      {.workers = 2},
      {.locate = [&](const SpotRequest& r) { return r.client_id == "slow" ? gate.pass(r) : verified(r); }},
      answers.sink());
  scheduler.submit(arrival("slow", 1));
  gate.wait_inside();
  scheduler.submit(arrival("slow", 2));
  scheduler.submit(arrival("b", 1));
  EXPECT_TRUE(answers.wait_for(1)) << "the second request of the slow client has taken the other worker";
  EXPECT_EQ(answers.reason("b", 1), Reason::confirmed);
  EXPECT_EQ(scheduler.counters().queued, 1U) << "it may still be superseded";
  gate.open();
  ASSERT_TRUE(answers.wait_for(3));
  EXPECT_EQ(answers.reason("slow", 2), Reason::confirmed);
  answers.expect_each_once(3);
}

// A localizer that knows clients by their requests, as the real one does.
class Known {
 public:
  void add(const std::string& client_id) {
    const std::scoped_lock lock(mutex_);
    known_.insert(client_id);
  }
  void erase(const std::string& client_id) {
    const std::scoped_lock lock(mutex_);
    known_.erase(client_id);
  }
  bool empty() {
    const std::scoped_lock lock(mutex_);
    return known_.empty();
  }

 private:
  std::mutex mutex_;
  std::set<std::string> known_;
};

TEST(SchedulerClients, NothingIsKeptOfAClientThatLeftWhileItsRequestsWereInHand) {
  Gate gate;
  Answers answers;
  Known known;
  const auto locate = [&](const SpotRequest& r) {
    const SpotReply reply = gate.pass(r);
    known.add(r.client_id);
    return reply;
  };
  RequestScheduler scheduler({.workers = 1},
                             {.locate = locate,
                              .forget = [&](const std::string& id) { known.erase(id); },
                              .on_answer = [&](const SpotReply& reply) { known.add(reply.client_id); }},
                             answers.sink());
  scheduler.submit(arrival("in work", 1));
  gate.wait_inside();
  scheduler.submit(arrival("waiting", 1));
  scheduler.client_left("in work");
  scheduler.client_left("waiting");
  EXPECT_EQ(scheduler.counters().queued, 0U);
  gate.open();
  ASSERT_TRUE(answers.wait_for(2));
  scheduler.stop();
  EXPECT_TRUE(known.empty());
  answers.expect_each_once(2);
}

/// What happened, in its order.
class Events {
 public:
  void note(std::string event) {
    const std::scoped_lock lock(mutex_);
    all_.push_back(std::move(event));
  }
  [[nodiscard]] std::vector<std::string> all() const {
    const std::scoped_lock lock(mutex_);
    return all_;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::string> all_;
};

TEST(SchedulerClients, WhatAnEndedRunLeftBehindIsForgottenBeforeTheNextIsAnswered) {
  Gate gate;
  Answers answers;
  Events events;
  const auto locate = [&](const SpotRequest& r) {
    const SpotReply reply = gate.pass(r);
    events.note("answered " + std::to_string(r.seq));
    return reply;
  };
  RequestScheduler scheduler(
      {.workers = 2}, {.locate = locate, .forget = [&](const std::string&) { events.note("forgotten"); }},
      answers.sink());
  scheduler.submit(arrival("a", 7, 1));
  gate.wait_inside();
  scheduler.submit(arrival("a", 1, 2));
  gate.open();
  ASSERT_TRUE(answers.wait_for(2));
  scheduler.stop();
  EXPECT_EQ(events.all(), (std::vector<std::string>{"forgotten", "answered 7", "forgotten", "answered 1"}));
  answers.expect_each_once(2);
}

TEST(SchedulerClients, ARunThatComesBackWithAnotherWriterIsNotForgottenByItsOldRequest) {
  Gate gate;
  Answers answers;
  Events events;
  ServiceBackend backend{.locate = [&](const SpotRequest& r) { return gate.pass(r); }};
  backend.forget = [&](const std::string&) { events.note("forgotten"); };
  backend.begin = [&](const std::string&, std::uint64_t) { events.note("begun"); };
  RequestScheduler scheduler({.workers = 2}, backend, answers.sink());
  scheduler.submit(arrival("a", 1, 5));
  gate.wait_inside();
  wire::Arrival again = arrival("a", 2, 5);
  again.from.publication += 1000;
  scheduler.submit(std::move(again));
  gate.open();
  ASSERT_TRUE(answers.wait_for(2));
  scheduler.stop();
  EXPECT_EQ(events.all(), (std::vector<std::string>{"begun", "forgotten", "begun"}));
}

}  // namespace
}  // namespace liloc
