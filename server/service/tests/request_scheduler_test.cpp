#include "server/service/request_scheduler.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "server/service/tests/answers.hpp"

namespace liloc {
namespace {

using namespace std::chrono_literals;
using namespace test;

TEST(RequestScheduler, AFullQueueRefusesTheOldestOfStrangers) {
  Gate gate;
  Answers answers;
  RequestScheduler scheduler({.queue = 2}, {.locate = [&](const SpotRequest& r) { return gate.pass(r); }},
                             answers.sink());
  scheduler.submit(arrival("a", 1));
  gate.wait_inside();
  for (const char* client : {"b", "c", "d"}) scheduler.submit(arrival(client, 1));
  EXPECT_EQ(answers.reason("b", 1), Reason::overloaded);
  EXPECT_EQ(scheduler.counters().queued, 2U);
  gate.open();
  ASSERT_TRUE(answers.wait_for(4));
  EXPECT_EQ(answers.reason("d", 1), Reason::confirmed);
  answers.expect_each_once(4);
}

TEST(RequestScheduler, ANewerRequestOfTheSameClientTakesTheOlderOnesPlace) {
  Gate gate;
  Answers answers;
  RequestScheduler scheduler({}, {.locate = [&](const SpotRequest& r) { return gate.pass(r); }},
                             answers.sink());
  scheduler.submit(arrival("busy", 1));
  gate.wait_inside();
  scheduler.submit(arrival("a", 1));
  scheduler.submit(arrival("a", 3));
  scheduler.submit(arrival("a", 2));  // overtaken on the way
  EXPECT_EQ(answers.reason("a", 1), Reason::superseded);
  EXPECT_EQ(answers.reason("a", 2), Reason::superseded);
  gate.open();
  ASSERT_TRUE(answers.wait_for(4));
  EXPECT_EQ(answers.reason("a", 3), Reason::confirmed);
  answers.expect_each_once(4);
}

TEST(RequestScheduler, TellsEachAnswerHowLongItTookWhereAndHowClientsStand) {
  std::mutex mutex;
  std::map<Stage, std::vector<double>> seconds;
  std::map<Reason, int> told;
  std::atomic<bool> ready = false;
  Answers answers;
  ServiceBackend backend;
  backend.locate = [](const SpotRequest& r) {
    std::this_thread::sleep_for(20ms);
    return r.client_id == "a" ? verified(r) : refusal(r, Reason::not_found, "");
  };
  backend.seen_until = [&] { return std::optional<StampNs>(ready ? 1 : 0); };
  backend.on_stage = [&](Stage stage, double s) {
    const std::scoped_lock lock(mutex);
    seconds[stage].push_back(s);
  };
  backend.on_answer = [&](const SpotReply& reply) {
    const std::scoped_lock lock(mutex);
    ++told[reply.reason];
  };
  RequestScheduler scheduler({.hold = 10s}, backend, answers.sink());
  scheduler.submit(arrival("a", 1));  // waits for the ceiling
  std::this_thread::sleep_for(30ms);
  ready = true;
  scheduler.release();
  ASSERT_TRUE(answers.wait_for(1));
  scheduler.submit(arrival("b", 1));
  ASSERT_TRUE(answers.wait_for(2));
  scheduler.submit(arrival("a", 1));  // late: not the localizer's answer
  ASSERT_TRUE(answers.wait_for(3));
  const std::scoped_lock lock(mutex);
  ASSERT_EQ(seconds[Stage::hold].size(), 1U);
  EXPECT_GE(seconds[Stage::hold][0], 0.03);
  ASSERT_EQ(seconds[Stage::wait].size(), 2U);
  EXPECT_GE(seconds[Stage::wait][0], seconds[Stage::hold][0]);
  ASSERT_EQ(seconds[Stage::work].size(), 2U);
  for (const double s : seconds[Stage::work]) EXPECT_GE(s, 0.02);
  EXPECT_EQ(told, (std::map<Reason, int>{{Reason::confirmed, 1}, {Reason::not_found, 1}, {Reason::late, 1}}));
  EXPECT_EQ(scheduler.counters().clients_verified, 1U);
  EXPECT_EQ(scheduler.counters().clients_refused, 1U);
  EXPECT_EQ(scheduler.counters().clients_provisional, 0U);
}

TEST(RequestScheduler, TellsWhichRunOfAClientBeginsAndWhoseRequestWasLocated) {
  std::mutex mutex;
  std::vector<std::string> told;
  const auto say = [&](const std::string& what, const std::string& client, std::uint64_t session) {
    const std::scoped_lock lock(mutex);
    told.push_back(what + " " + client + " " + std::to_string(session));
  };
  Answers answers;
  ServiceBackend backend{.locate = verified};
  backend.forget = [&](const std::string& client) { say("forget", client, 0); };
  backend.begin = [&](const std::string& client, std::uint64_t session) { say("begin", client, session); };
  backend.on_located = [&](const std::string& client, std::uint64_t session) {
    say("located", client, session);
  };
  RequestScheduler scheduler({}, backend, answers.sink());
  scheduler.submit(arrival("a", 1, 5));
  ASSERT_TRUE(answers.wait_for(1));
  scheduler.submit(arrival("a", 2, 5));
  ASSERT_TRUE(answers.wait_for(2));
  scheduler.submit(arrival("a", 3, 6));
  ASSERT_TRUE(answers.wait_for(3));
  const std::scoped_lock lock(mutex);
  EXPECT_EQ(told, (std::vector<std::string>{"begin a 5", "located a 5", "located a 5", "forget a 0",
                                            "begin a 6", "located a 6"}));
}

TEST(RequestScheduler, TellsHowLongAWorkerHasBeenOverOneRequest) {
  Gate gate;
  Answers answers;
  RequestScheduler scheduler({.workers = 2}, {.locate = [&](const SpotRequest& r) { return gate.pass(r); }},
                             answers.sink());
  EXPECT_EQ(scheduler.counters().longest_work_s, 0);
  scheduler.submit(arrival("a", 1));
  gate.wait_inside();
  std::this_thread::sleep_for(30ms);
  EXPECT_GE(scheduler.counters().longest_work_s, 0.03);
  gate.open();
  ASSERT_TRUE(answers.wait_for(1));
  while (scheduler.counters().longest_work_s > 0) std::this_thread::sleep_for(1ms);
}

TEST(RequestScheduler, AProblemSeenOnTheWayIsPassedOn) {
  Answers answers;
  RequestScheduler scheduler({}, {.locate = verified}, answers.sink());
  auto bad = arrival("a", 1);
  bad.problem = Reason::identity;
  scheduler.submit(std::move(bad));
  EXPECT_EQ(answers.reason("a", 1), Reason::identity);
}

TEST(RequestScheduler, AnExceptionOfTheLocalizerIsAnAnswer) {
  Answers answers;
  RequestScheduler scheduler(
      {}, {.locate = [](const SpotRequest&) -> SpotReply { throw std::runtime_error("bug"); }}, answers.sink());
  scheduler.submit(arrival("a", 1));
  ASSERT_TRUE(answers.wait_for(1));
  EXPECT_EQ(answers.reason("a", 1), Reason::not_found);
}

TEST(RequestScheduler, ARequestWaitsForTheCeilingButNotForever) {
  Answers answers;
  std::atomic<StampNs> seen = 0;
  RequestScheduler scheduler(
      {.hold = 500ms},
      {.locate = verified, .forget = {}, .seen_until = [&] { return std::optional(seen.load()); }},
      answers.sink());
  scheduler.submit(arrival("a", 1));
  scheduler.submit(arrival("b", 2));
  scheduler.release();
  EXPECT_EQ(scheduler.counters().queued, 2U);
  seen = 1;
  scheduler.release();
  ASSERT_TRUE(answers.wait_for(1));
  EXPECT_EQ(answers.reason("a", 1), Reason::confirmed);
  EXPECT_EQ(answers.reason("b", 2), Reason::no_answer);
  std::this_thread::sleep_for(550ms);
  scheduler.release();
  ASSERT_TRUE(answers.wait_for(2));
  EXPECT_EQ(answers.reason("b", 2), Reason::confirmed);
}

TEST(RequestScheduler, AReleaseAsksForTheCeilingOnceHoweverManyWait) {
  Answers answers;
  std::atomic<int> asked = 0;
  ServiceBackend backend;
  backend.locate = verified;
  backend.seen_until = [&] {
    ++asked;
    return std::optional<StampNs>(0);
  };
  RequestScheduler scheduler({.hold = 10s}, backend, answers.sink());
  scheduler.release();
  EXPECT_EQ(asked, 0) << "nobody waits";
  for (std::uint64_t seq = 1; seq <= 20; ++seq) scheduler.submit(arrival("client" + std::to_string(seq), seq));
  asked = 0;
  scheduler.release();
  EXPECT_EQ(asked, 1);
  EXPECT_EQ(scheduler.counters().queued, 20U);
}

TEST(RequestScheduler, NobodyWaitsForACeilingOfWhichNoLidarIsHeard) {
  Answers answers;
  ServiceBackend backend;
  backend.locate = verified;
  backend.seen_until = [] { return std::optional<StampNs>(); };
  RequestScheduler scheduler({.hold = 10s}, backend, answers.sink());
  scheduler.submit(arrival("a", 1));
  ASSERT_TRUE(answers.wait_for(1));
}

TEST(RequestScheduler, StoppingFinishesWhatWaitsAndRefusesTheRest) {
  Gate gate;
  Answers answers;
  RequestScheduler scheduler({},
                             {.locate = [&](const SpotRequest& r) { return gate.pass(r); },
                              .forget = {},
                              .seen_until = [] { return std::optional<StampNs>(8); }},
                             answers.sink());
  scheduler.submit(arrival("a", 1));
  gate.wait_inside();
  scheduler.submit(arrival("b", 1));
  scheduler.submit(arrival("held", 9));
  std::thread opener([&] {
    std::this_thread::sleep_for(50ms);
    gate.open();
  });
  scheduler.stop();
  opener.join();
  scheduler.submit(arrival("c", 1));
  EXPECT_EQ(answers.reason("a", 1), Reason::confirmed);
  EXPECT_EQ(answers.reason("b", 1), Reason::confirmed);
  EXPECT_EQ(answers.reason("held", 9), Reason::confirmed);
  EXPECT_EQ(answers.reason("c", 1), Reason::shutting_down);
  answers.expect_each_once(4);
}

// Eight threads, four workers, a queue of eight, a stop in the midst: each request is answered exactly once.
TEST(RequestScheduler, UnderLoadEachRequestIsAnsweredExactlyOnce) {
  Answers answers;
  const auto locate = [](const SpotRequest& r) {
    std::this_thread::sleep_for(std::chrono::microseconds(200 + r.seq % 7 * 100));
    return verified(r);
  };
  std::atomic<StampNs> seen = 0;
  RequestScheduler scheduler(
      {.workers = 4, .queue = 8, .max_rate_hz = 10'000, .hold = 5ms},
      {.locate = locate, .forget = {}, .seen_until = [&] { return std::optional(seen.load()); }},
      answers.sink());
  constexpr int kThreads = 8;
  constexpr std::uint64_t kEach = 300;
  std::vector<std::thread> clients;
  clients.reserve(kThreads);
  for (int t = 0; t < kThreads; ++t)
    clients.emplace_back([&, t] {
      for (std::uint64_t seq = 1; seq <= kEach; ++seq) {
        scheduler.submit(arrival("client" + std::to_string(t), seq));
        if (seq % 3 == 0) std::this_thread::sleep_for(300us);
        seen = static_cast<StampNs>(seq > 2 ? seq - 2 : 0);
        if (seq % 5 == 0) scheduler.release();
      }
    });
  std::this_thread::sleep_for(20ms);
  scheduler.stop();
  for (auto& client : clients) client.join();
  answers.expect_each_once(kThreads * kEach);
  const auto counters = scheduler.counters();
  EXPECT_EQ(counters.answered, kThreads * kEach);
  EXPECT_EQ(counters.verified + counters.refused, kThreads * kEach);
  EXPECT_EQ(counters.queued, 0U);
}

}  // namespace
}  // namespace liloc
