#include "server/service/desk.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <map>
#include <set>

#include "common/base/log.hpp"

namespace liloc {
namespace {

using namespace std::chrono_literals;
using Key = std::pair<std::string, std::uint64_t>;

wire::Arrival arrival(const std::string& client, std::uint64_t seq, std::uint64_t session = 1) {
  wire::Arrival a;
  a.from = {client, std::hash<std::string>{}(client) + session, session};
  a.request.client_id = client;
  a.request.seq = seq;
  a.request.stamp_ns = static_cast<StampNs>(seq);
  a.at = std::chrono::steady_clock::now();
  return a;
}

// Collects every answer; a count other than one for any request is a fault of the desk.
class Answers {
 public:
  Desk::Answer sink() {
    return [this](const wire::Sender& to, SpotReply reply) {
      const std::scoped_lock lock(mutex_);
      EXPECT_EQ(to.client_id, reply.client_id);
      EXPECT_GE(reply.latency_ms, 0);
      ++count_[{reply.client_id, reply.seq}];
      replies_[{reply.client_id, reply.seq}] = std::move(reply);
      ++total_;
      changed_.notify_all();
    };
  }
  bool wait_for(std::size_t total) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, 10s, [&] { return total_ >= total; });
  }
  Reason reason(const std::string& client, std::uint64_t seq) {
    const std::scoped_lock lock(mutex_);
    const auto found = replies_.find({client, seq});
    return found == replies_.end() ? Reason::no_answer : found->second.reason;
  }
  std::size_t count(Reason reason) {
    const std::scoped_lock lock(mutex_);
    return static_cast<std::size_t>(
        std::ranges::count_if(replies_, [&](const auto& r) { return r.second.reason == reason; }));
  }
  void expect_each_once(std::size_t requests) {
    const std::scoped_lock lock(mutex_);
    EXPECT_EQ(count_.size(), requests);
    for (const auto& [key, count] : count_) EXPECT_EQ(count, 1) << key.first << " " << key.second;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::map<Key, int> count_;
  std::map<Key, SpotReply> replies_;
  std::size_t total_ = 0;
};

// A localizer that works on one request until the test opens the gate.
class Gate {
 public:
  SpotReply pass(const SpotRequest& request) {
    std::unique_lock lock(mutex_);
    ++inside_;
    changed_.notify_all();
    changed_.wait(lock, [&] { return open_; });
    SpotReply reply = refusal(request, Reason::confirmed, "");
    reply.status = SpotStatus::verified;
    return reply;
  }
  void wait_inside() {
    std::unique_lock lock(mutex_);
    ASSERT_TRUE(changed_.wait_for(lock, 10s, [&] { return inside_ > 0; }));
  }
  void open() {
    const std::scoped_lock lock(mutex_);
    open_ = true;
    changed_.notify_all();
  }
  void close() {
    const std::scoped_lock lock(mutex_);
    open_ = false;
    inside_ = 0;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  bool open_ = false;
  int inside_ = 0;
};

SpotReply verified(const SpotRequest& request) {
  SpotReply reply = refusal(request, Reason::confirmed, "");
  reply.status = SpotStatus::verified;
  return reply;
}

TEST(Desk, AFullQueueRefusesTheOldestOfStrangers) {
  Gate gate;
  Answers answers;
  Desk desk({.queue = 2}, {.locate = [&](const SpotRequest& r) { return gate.pass(r); }}, answers.sink());
  desk.submit(arrival("a", 1));
  gate.wait_inside();
  for (const char* client : {"b", "c", "d"}) desk.submit(arrival(client, 1));
  EXPECT_EQ(answers.reason("b", 1), Reason::overloaded);
  EXPECT_EQ(desk.counters().queued, 2U);
  gate.open();
  ASSERT_TRUE(answers.wait_for(4));
  EXPECT_EQ(answers.reason("d", 1), Reason::confirmed);
  answers.expect_each_once(4);
}

TEST(Desk, ANewerRequestOfTheSameClientTakesTheOlderOnesPlace) {
  Gate gate;
  Answers answers;
  Desk desk({}, {.locate = [&](const SpotRequest& r) { return gate.pass(r); }}, answers.sink());
  desk.submit(arrival("busy", 1));
  gate.wait_inside();
  desk.submit(arrival("a", 1));
  desk.submit(arrival("a", 3));
  desk.submit(arrival("a", 2));  // overtaken on the way
  EXPECT_EQ(answers.reason("a", 1), Reason::superseded);
  EXPECT_EQ(answers.reason("a", 2), Reason::superseded);
  gate.open();
  ASSERT_TRUE(answers.wait_for(4));
  EXPECT_EQ(answers.reason("a", 3), Reason::confirmed);
  answers.expect_each_once(4);
}

TEST(Desk, TellsEachAnswerHowLongItTookWhereAndHowClientsStand) {
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
  Desk desk({.hold = 10s}, backend, answers.sink());
  desk.submit(arrival("a", 1));  // waits for the ceiling
  std::this_thread::sleep_for(30ms);
  ready = true;
  desk.release();
  ASSERT_TRUE(answers.wait_for(1));
  desk.submit(arrival("b", 1));
  ASSERT_TRUE(answers.wait_for(2));
  desk.submit(arrival("a", 1));  // late: not the localizer's answer
  ASSERT_TRUE(answers.wait_for(3));
  const std::scoped_lock lock(mutex);
  ASSERT_EQ(seconds[Stage::hold].size(), 1U);
  EXPECT_GE(seconds[Stage::hold][0], 0.03);
  ASSERT_EQ(seconds[Stage::wait].size(), 2U);
  EXPECT_GE(seconds[Stage::wait][0], seconds[Stage::hold][0]);
  ASSERT_EQ(seconds[Stage::work].size(), 2U);
  for (const double s : seconds[Stage::work]) EXPECT_GE(s, 0.02);
  EXPECT_EQ(told, (std::map<Reason, int>{{Reason::confirmed, 1}, {Reason::not_found, 1}, {Reason::late, 1}}));
  EXPECT_EQ(desk.counters().clients_verified, 1U);
  EXPECT_EQ(desk.counters().clients_refused, 1U);
  EXPECT_EQ(desk.counters().clients_provisional, 0U);
}

TEST(Desk, ARequestNoNewerThanTheLastAnswerIsLate) {
  Answers answers;
  Desk desk({}, {.locate = verified}, answers.sink());
  desk.submit(arrival("a", 5));
  ASSERT_TRUE(answers.wait_for(1));
  desk.submit(arrival("a", 4));
  EXPECT_EQ(answers.reason("a", 4), Reason::late);
}

wire::Arrival from_writer(std::uint64_t publication, const std::string& client, std::uint64_t seq) {
  wire::Arrival a = arrival(client, seq);
  a.from.publication = publication;
  return a;
}

TEST(Desk, AForeignWritersLargeSeqMakesNobodyLate) {
  Answers answers;
  Desk desk({}, {.locate = verified}, answers.sink());
  desk.submit(from_writer(1, "a", 5));
  ASSERT_TRUE(answers.wait_for(1));
  desk.submit(from_writer(2, "a", 1'000'000));  // the same session: it was read off the wire
  ASSERT_TRUE(answers.wait_for(2));
  for (std::uint64_t seq = 6; seq < 9; ++seq) desk.submit(from_writer(1, "a", seq));
  ASSERT_TRUE(answers.wait_for(5));
  EXPECT_EQ(answers.reason("a", 8), Reason::confirmed);
  desk.submit(from_writer(1, "a", 8));
  EXPECT_EQ(answers.reason("a", 8), Reason::late) << "its own order still counts";
}

TEST(Desk, TwoDevicesOfOneIdAreToldInTheLog) {
  std::vector<std::string> lines;
  log::set_sink([&](log::Level level, std::string_view line) {
    if (level == log::Level::warning) lines.emplace_back(line);
  });
  {
    Answers answers;
    Desk desk({}, {.locate = verified}, answers.sink());
    for (std::uint64_t i = 0; i < 10; ++i) {
      desk.submit(from_writer(1 + i % 2, "twin", 1 + i));
      ASSERT_TRUE(answers.wait_for(i + 1));
    }
    desk.submit(arrival("other", 1));
  }
  log::set_sink({});
  ASSERT_EQ(lines.size(), 1U);
  EXPECT_NE(lines[0].find("two devices ask as twin"), std::string::npos) << lines[0];
}

TEST(Desk, ARestartIsNoSecondDevice) {
  std::vector<std::string> lines;
  log::set_sink([&](log::Level level, std::string_view line) {
    if (level == log::Level::warning) lines.emplace_back(line);
  });
  {
    Answers answers;
    Desk desk({}, {.locate = verified}, answers.sink());
    for (std::uint64_t run = 1; run < 5; ++run) {
      desk.submit(from_writer(run, "a", 1));
      ASSERT_TRUE(answers.wait_for(run));
    }
  }
  log::set_sink({});
  EXPECT_TRUE(lines.empty()) << lines[0];
}

TEST(Desk, ARestartedClientBeginsAnewAndIsForgotten) {
  Answers answers;
  std::atomic<int> forgotten = 0;
  Desk desk({}, {.locate = verified, .forget = [&](const std::string&) { ++forgotten; }}, answers.sink());
  desk.submit(arrival("a", 5, 1));
  ASSERT_TRUE(answers.wait_for(1));
  desk.submit(arrival("a", 1, 2));
  ASSERT_TRUE(answers.wait_for(2));
  EXPECT_EQ(answers.reason("a", 1), Reason::confirmed);
  EXPECT_EQ(forgotten, 1);
  desk.client_left("a");
  EXPECT_EQ(forgotten, 2);
}

TEST(Desk, AFloodIsLimitedPerClient) {
  Answers answers;
  Desk desk({.max_rate_hz = 1}, {.locate = verified}, answers.sink());
  for (std::uint64_t seq = 1; seq <= 50; ++seq) desk.submit(arrival("flood", seq));
  desk.submit(arrival("calm", 1));
  ASSERT_TRUE(answers.wait_for(51));
  EXPECT_EQ(answers.reason("flood", 50), Reason::rate_limit);
  EXPECT_EQ(answers.reason("calm", 1), Reason::confirmed);
  answers.expect_each_once(51);
}

TEST(Desk, AFloodIsLimitedPerIdentityHoweverManyWritersItHas) {
  Answers answers;
  Desk desk({.max_rate_hz = 5}, {.locate = verified}, answers.sink());
  for (std::uint64_t writer = 1; writer <= 50; ++writer) {
    auto one = arrival("flood", writer);
    one.from.publication = writer;
    desk.submit(std::move(one));
  }
  ASSERT_TRUE(answers.wait_for(50));
  EXPECT_EQ(answers.count(Reason::rate_limit), 45U);
}

// Answers clients of which `known_` are verified, one at a time and only once the gate is open.
class Ranked : public testing::Test {
 protected:
  void verify(const std::string& client) {
    gate_.open();
    desk_.submit(arrival(client, 1));
    ASSERT_TRUE(answers_.wait_for(++verified_));
    gate_.close();
  }
  SpotReply locate(const SpotRequest& request) {
    {
      const std::scoped_lock lock(mutex_);
      order_.push_back(request.client_id);
    }
    return gate_.pass(request);
  }
  std::vector<std::string> order_after(std::size_t answers) {
    gate_.open();
    EXPECT_TRUE(answers_.wait_for(answers));
    desk_.stop();
    return {order_.end() - static_cast<std::ptrdiff_t>(answers - verified_), order_.end()};
  }

  Gate gate_;
  Answers answers_;
  std::mutex mutex_;
  std::vector<std::string> order_;
  std::size_t verified_ = 0;
  Desk desk_{{.queue = 4}, {.locate = [this](const SpotRequest& r) { return locate(r); }}, answers_.sink()};
};

wire::Arrival lost(const std::string& client, std::uint64_t seq) {
  auto asked = arrival(client, seq);
  asked.request.odom_segment = 7;
  return asked;
}

TEST_F(Ranked, TrackedDevicesComeBeforeSearchesAndKnownOnesBeforeStrangers) {
  for (const char* client : {"tracked", "known"}) verify(client);
  desk_.submit(arrival("stranger1", 1));
  gate_.wait_inside();
  desk_.submit(arrival("stranger2", 1));
  desk_.submit(lost("known", 2));
  desk_.submit(arrival("tracked", 2));
  EXPECT_EQ(order_after(6), (std::vector<std::string>{"stranger1", "tracked", "known", "stranger2"}));
}

TEST_F(Ranked, WhoWasServedLongestAgoComesFirst) {
  for (const char* client : {"a", "b", "c"}) verify(client);
  desk_.submit(arrival("stranger", 1));
  gate_.wait_inside();
  for (const char* client : {"c", "a", "b"}) desk_.submit(arrival(client, 2));
  EXPECT_EQ(order_after(7), (std::vector<std::string>{"stranger", "a", "b", "c"}));
}

TEST_F(Ranked, AFullQueueRefusesStrangersBeforeAnyoneElse) {
  for (const char* client : {"tracked", "known"}) verify(client);
  desk_.submit(arrival("stranger", 1));
  gate_.wait_inside();
  desk_.submit(arrival("tracked", 2));
  desk_.submit(lost("known", 2));
  for (int i = 0; i < 500; ++i) desk_.submit(arrival("flood" + std::to_string(i), 1));
  gate_.open();
  ASSERT_TRUE(answers_.wait_for(505));
  EXPECT_EQ(answers_.reason("tracked", 2), Reason::confirmed);
  EXPECT_EQ(answers_.reason("known", 2), Reason::confirmed);
  EXPECT_EQ(answers_.count(Reason::overloaded), 498U);
}

Waiting waiting(const std::string& client, Standing standing) {
  return {arrival(client, 1), standing, std::chrono::steady_clock::now()};
}

TEST(WaitingLine, SearchesGetTheirShareThoughTrackedDevicesNeverCease) {
  WaitingLine line(16);
  std::chrono::milliseconds searching{0}, tracking{0};
  for (const auto* busy : {"a", "b"}) ASSERT_FALSE(line.push(waiting(busy, Standing::tracked)));
  for (const auto* lost : {"x", "y"}) ASSERT_FALSE(line.push(waiting(lost, Standing::known)));
  while (tracking + searching < 20s) {
    auto begun = line.begin();
    ASSERT_TRUE(begun);
    const auto took = begun->searches() ? 50ms : 4ms;
    (begun->searches() ? searching : tracking) += took;
    line.end(*begun, took);
    ASSERT_FALSE(line.push(waiting(begun->arrival.from.client_id, begun->standing)));
  }
  EXPECT_GT(searching, 4s);
  EXPECT_LT(searching, 6s);
}

TEST(WaitingLine, WorkersThatAskAtOnceDoNotAllBeginSearches) {
  WaitingLine line(32);
  for (int i = 0; i < 4; ++i) ASSERT_FALSE(line.push(waiting(fmt::format("lost{}", i), Standing::known)));
  for (int i = 0; i < 31; ++i) {  // 124 ms of tracked work: one search of 40 ms is owed, and no second one
    ASSERT_FALSE(line.push(waiting("busy", Standing::tracked)));
    auto begun = line.begin();
    ASSERT_TRUE(begun && !begun->searches());
    line.end(*begun, 4ms);
  }
  int searching = 0;
  for (int i = 0; i < 4; ++i) {
    ASSERT_FALSE(line.push(waiting(fmt::format("busy{}", i), Standing::tracked)));
    searching += line.begin()->searches() ? 1 : 0;
  }
  EXPECT_EQ(searching, 1);
}

TEST(WaitingLine, LongSearchesGetNoMoreThanTheirShare) {
  WaitingLine line(16);
  std::chrono::milliseconds searching{0}, tracking{0};
  ASSERT_FALSE(line.push(waiting("busy", Standing::tracked)));
  ASSERT_FALSE(line.push(waiting("lost", Standing::known)));
  while (tracking + searching < 20s) {
    auto begun = line.begin();
    ASSERT_TRUE(begun);
    const auto took = begun->searches() ? 150ms : 4ms;
    (begun->searches() ? searching : tracking) += took;
    line.end(*begun, took);
    ASSERT_FALSE(line.push(waiting(begun->arrival.from.client_id, begun->standing)));
  }
  EXPECT_GT(searching, 4s);
  EXPECT_LT(searching, 6s);
}

TEST(WaitingLine, SearchesGetAllTheTimeThatNobodyElseWants) {
  WaitingLine line(16);
  for (int i = 0; i < 10; ++i) {
    ASSERT_FALSE(line.push(waiting("x", Standing::stranger)));
    auto begun = line.begin();
    ASSERT_TRUE(begun);
    line.end(*begun, 50ms);
  }
}

TEST(Desk, AProblemSeenOnTheWayIsPassedOn) {
  Answers answers;
  Desk desk({}, {.locate = verified}, answers.sink());
  auto bad = arrival("a", 1);
  bad.problem = Reason::identity;
  desk.submit(std::move(bad));
  EXPECT_EQ(answers.reason("a", 1), Reason::identity);
}

TEST(Desk, AnExceptionOfTheLocalizerIsAnAnswer) {
  Answers answers;
  Desk desk({}, {.locate = [](const SpotRequest&) -> SpotReply { throw std::runtime_error("bug"); }},
            answers.sink());
  desk.submit(arrival("a", 1));
  ASSERT_TRUE(answers.wait_for(1));
  EXPECT_EQ(answers.reason("a", 1), Reason::not_found);
}

TEST(Desk, ARequestWaitsForTheCeilingButNotForever) {
  Answers answers;
  std::atomic<StampNs> seen = 0;
  Desk desk({.hold = 500ms},
            {.locate = verified, .forget = {}, .seen_until = [&] { return std::optional(seen.load()); }},
            answers.sink());
  desk.submit(arrival("a", 1));
  desk.submit(arrival("b", 2));
  desk.release();
  EXPECT_EQ(desk.counters().queued, 2U);
  seen = 1;
  desk.release();
  ASSERT_TRUE(answers.wait_for(1));
  EXPECT_EQ(answers.reason("a", 1), Reason::confirmed);
  EXPECT_EQ(answers.reason("b", 2), Reason::no_answer);
  std::this_thread::sleep_for(550ms);
  desk.release();
  ASSERT_TRUE(answers.wait_for(2));
  EXPECT_EQ(answers.reason("b", 2), Reason::confirmed);
}

TEST(Desk, AReleaseAsksForTheCeilingOnceHoweverManyWait) {
  Answers answers;
  std::atomic<int> asked = 0;
  ServiceBackend backend;
  backend.locate = verified;
  backend.seen_until = [&] {
    ++asked;
    return std::optional<StampNs>(0);
  };
  Desk desk({.hold = 10s}, backend, answers.sink());
  desk.release();
  EXPECT_EQ(asked, 0) << "nobody waits";
  for (std::uint64_t seq = 1; seq <= 20; ++seq) desk.submit(arrival("client" + std::to_string(seq), seq));
  asked = 0;
  desk.release();
  EXPECT_EQ(asked, 1);
  EXPECT_EQ(desk.counters().queued, 20U);
}

TEST(Desk, NobodyWaitsForACeilingOfWhichNoLidarIsHeard) {
  Answers answers;
  ServiceBackend backend;
  backend.locate = verified;
  backend.seen_until = [] { return std::optional<StampNs>(); };
  Desk desk({.hold = 10s}, backend, answers.sink());
  desk.submit(arrival("a", 1));
  ASSERT_TRUE(answers.wait_for(1));
}

TEST(Desk, StoppingFinishesWhatWaitsAndRefusesTheRest) {
  Gate gate;
  Answers answers;
  Desk desk({},
            {.locate = [&](const SpotRequest& r) { return gate.pass(r); },
             .forget = {},
             .seen_until = [] { return std::optional<StampNs>(8); }},
            answers.sink());
  desk.submit(arrival("a", 1));
  gate.wait_inside();
  desk.submit(arrival("b", 1));
  desk.submit(arrival("held", 9));
  std::thread opener([&] {
    std::this_thread::sleep_for(50ms);
    gate.open();
  });
  desk.stop();
  opener.join();
  desk.submit(arrival("c", 1));
  EXPECT_EQ(answers.reason("a", 1), Reason::confirmed);
  EXPECT_EQ(answers.reason("b", 1), Reason::confirmed);
  EXPECT_EQ(answers.reason("held", 9), Reason::confirmed);
  EXPECT_EQ(answers.reason("c", 1), Reason::shutting_down);
  answers.expect_each_once(4);
}

TEST(Desk, OneClientKeepsOneWorkerAtMost) {
  Gate gate;
  Answers answers;
  Desk desk(
      {.workers = 2},
      {.locate = [&](const SpotRequest& r) { return r.client_id == "slow" ? gate.pass(r) : verified(r); }},
      answers.sink());
  desk.submit(arrival("slow", 1));
  gate.wait_inside();
  desk.submit(arrival("slow", 2));
  desk.submit(arrival("b", 1));
  EXPECT_TRUE(answers.wait_for(1)) << "the second request of the slow client has taken the other worker";
  EXPECT_EQ(answers.reason("b", 1), Reason::confirmed);
  EXPECT_EQ(desk.counters().queued, 1U) << "it may still be superseded";
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

TEST(Desk, NothingIsKeptOfAClientThatLeftWhileItsRequestsWereInHand) {
  Gate gate;
  Answers answers;
  Known known;
  const auto locate = [&](const SpotRequest& r) {
    const SpotReply reply = gate.pass(r);
    known.add(r.client_id);
    return reply;
  };
  Desk desk({.workers = 1}, {.locate = locate, .forget = [&](const std::string& id) { known.erase(id); }},
            answers.sink());
  desk.submit(arrival("in work", 1));
  gate.wait_inside();
  desk.submit(arrival("waiting", 1));
  desk.client_left("in work");
  desk.client_left("waiting");
  EXPECT_EQ(desk.counters().queued, 0U);
  gate.open();
  ASSERT_TRUE(answers.wait_for(2));
  desk.stop();
  EXPECT_TRUE(known.empty());
  answers.expect_each_once(2);
}

TEST(Desk, WhatAnEndedRunLeftBehindIsForgottenBeforeTheNextIsAnswered) {
  Gate gate;
  Answers answers;
  std::mutex mutex;
  std::vector<std::string> events;
  const auto note = [&](std::string event) {
    const std::scoped_lock lock(mutex);
    events.push_back(std::move(event));
  };
  const auto locate = [&](const SpotRequest& r) {
    const SpotReply reply = gate.pass(r);
    note("answered " + std::to_string(r.seq));
    return reply;
  };
  Desk desk({.workers = 2}, {.locate = locate, .forget = [&](const std::string&) { note("forgotten"); }},
            answers.sink());
  desk.submit(arrival("a", 7, 1));
  gate.wait_inside();
  desk.submit(arrival("a", 1, 2));
  gate.open();
  ASSERT_TRUE(answers.wait_for(2));
  desk.stop();
  EXPECT_EQ(events, (std::vector<std::string>{"forgotten", "answered 7", "forgotten", "answered 1"}));
  answers.expect_each_once(2);
}

// Eight threads, four workers, a queue of eight, a stop in the midst: each request is answered exactly once.
TEST(Desk, UnderLoadEachRequestIsAnsweredExactlyOnce) {
  Answers answers;
  const auto locate = [](const SpotRequest& r) {
    std::this_thread::sleep_for(std::chrono::microseconds(200 + r.seq % 7 * 100));
    return verified(r);
  };
  std::atomic<StampNs> seen = 0;
  Desk desk({.workers = 4, .queue = 8, .max_rate_hz = 10'000, .hold = 5ms},
            {.locate = locate, .forget = {}, .seen_until = [&] { return std::optional(seen.load()); }},
            answers.sink());
  constexpr int kThreads = 8;
  constexpr std::uint64_t kEach = 300;
  std::vector<std::thread> clients;
  clients.reserve(kThreads);
  for (int t = 0; t < kThreads; ++t)
    clients.emplace_back([&, t] {
      for (std::uint64_t seq = 1; seq <= kEach; ++seq) {
        desk.submit(arrival("client" + std::to_string(t), seq));
        if (seq % 3 == 0) std::this_thread::sleep_for(300us);
        seen = static_cast<StampNs>(seq > 2 ? seq - 2 : 0);
        if (seq % 5 == 0) desk.release();
      }
    });
  std::this_thread::sleep_for(20ms);
  desk.stop();
  for (auto& client : clients) client.join();
  answers.expect_each_once(kThreads * kEach);
  const auto counters = desk.counters();
  EXPECT_EQ(counters.answered, kThreads * kEach);
  EXPECT_EQ(counters.verified + counters.refused, kThreads * kEach);
  EXPECT_EQ(counters.queued, 0U);
}

TEST(Desk, OptionsOutOfRangeAreNamed) {
  for (const auto& [options, field] : {std::pair{ServiceOptions{.workers = 0}, "workers"},
                                       {ServiceOptions{.queue = 0}, "queue"},
                                       {ServiceOptions{.max_rate_hz = 0}, "max_rate_hz"},
                                       {ServiceOptions{.max_clients = 0}, "max_clients"},
                                       {ServiceOptions{.server_id = "no blanks"}, "server_id"}}) {
    const auto valid = options.validated();
    ASSERT_FALSE(valid) << field;
    EXPECT_NE(valid.error().message.find(field), std::string::npos) << valid.error().message;
  }
}

}  // namespace
}  // namespace liloc
