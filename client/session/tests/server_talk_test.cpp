#include "client/session/server_talk.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>

namespace liloc {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

SpotRequest request(std::uint64_t seq) {
  SpotRequest r;
  r.seq = seq;
  r.stamp_ns = 1000 + static_cast<StampNs>(seq);
  return r;
}

SpotReply from(const char* server, std::uint64_t seq) {
  SpotReply r;
  r.server_id = server;
  r.seq = seq;
  r.stamp_ns = request(seq).stamp_ns;
  r.status = SpotStatus::verified;
  return r;
}

/// Whose requests have left when `ask` returns, unless the test's `send` waits.
class Talk : public testing::Test {
 protected:
  Talk() {
    log::set_sink([this](log::Level level, std::string_view line) {
      if (level < log::Level::info) return;
      lines_.push_back(std::string(line) + talk_.problem());  // who hears a line may ask
    });
  }
  ~Talk() override { log::set_sink({}); }
  void ask(std::uint64_t seq) {
    const std::size_t before = sent_;
    talk_.ask(request(seq));
    while (sent_ == before) std::this_thread::yield();
  }

  const ServerTalk::Time begin_ = std::chrono::steady_clock::now();
  std::vector<std::string> lines_;
  std::atomic<std::size_t> sent_ = 0;
  SessionClock clock_;
  SessionReport report_{"robot1"};
  ServerTalk talk_{"robot1", CloudCodec::draco,
                   [this](const SpotRequest&) {
                     ++sent_;
                     return Status{};
                   },
                   clock_, report_};
};

TEST(ServerTalk, ASlowNetworkCostsTheOldestOfTheRequestsThatWait) {
  SessionClock clock;
  SessionReport report("robot1");
  std::promise<void> first_is_sent, release;
  const auto released = release.get_future().share();
  std::vector<std::uint64_t> sent;
  ServerTalk talk(
      "robot1", CloudCodec::draco,
      [&](const SpotRequest& r) {
        sent.push_back(r.seq);
        if (r.seq == 1) first_is_sent.set_value();
        released.wait();
        return Status{};
      },
      clock, report);
  talk.ask(request(1));
  first_is_sent.get_future().wait();
  for (std::uint64_t seq = 2; seq <= 5; ++seq) talk.ask(request(seq));
  release.set_value();
  talk.close();
  talk.close();
  talk.ask(request(6));
  EXPECT_THAT(sent, ElementsAre(1, 4, 5)) << "what waited is sent at the end, and nothing after it";
  EXPECT_EQ(report.stats().requests, 6U);
  EXPECT_EQ(report.stats().requests_unsent, 3U);
}

TEST(ServerTalk, WhatDoesNotLeaveIsCounted) {
  SessionClock clock;
  SessionReport report("robot1");
  for (const auto& send :
       {ServerTalk::Send(), ServerTalk::Send([](const SpotRequest&) { return Status(fail("no route")); })}) {
    ServerTalk talk("robot1", CloudCodec::draco, send, clock, report);
    talk.ask(request(1));
    talk.close();
  }
  EXPECT_EQ(report.stats().requests_unsent, 2U);
}

TEST_F(Talk, AReplyCountsWhereItWasAskedFor) {
  EXPECT_FALSE(talk_.takes(from("edge1", 1)));
  ask(1);
  EXPECT_TRUE(talk_.takes(from("edge1", 1)));
  SpotReply of_another_frame = from("edge1", 1);
  ++of_another_frame.stamp_ns;
  EXPECT_FALSE(talk_.takes(of_another_frame));
  EXPECT_EQ(report_.stats().replies_strange, 2U);
  EXPECT_THAT(lines_, ElementsAre(HasSubstr("a reply of edge1 to request 1, which was not sent")));
}

TEST_F(Talk, IsUnansweredAQuarterOfASecondAfterTheFirstRequestUntilAnyReply) {
  EXPECT_FALSE(talk_.unanswered(begin_ + 1h));
  ask(1);
  ask(2);
  const auto asked = std::chrono::steady_clock::now();
  EXPECT_FALSE(talk_.unanswered(begin_ + 240ms));
  EXPECT_TRUE(talk_.unanswered(asked + 260ms));
  EXPECT_TRUE(talk_.takes(from("edge1", 1)));
  EXPECT_FALSE(talk_.unanswered(asked + 260ms));
}

TEST_F(Talk, TheStandbysAnswerCountsOnceAndTheChangeIsTold) {
  ask(1);
  EXPECT_TRUE(talk_.takes(from("edge1", 1), begin_));
  ask(2);
  EXPECT_FALSE(talk_.takes(from("edge2", 2), begin_));
  EXPECT_FALSE(talk_.take_overdue(begin_ + 90ms));
  EXPECT_THAT(lines_, IsEmpty());
  const auto overdue = talk_.take_overdue(begin_ + 110ms);
  ASSERT_TRUE(overdue);
  EXPECT_EQ(overdue->server_id, "edge2");
  EXPECT_FALSE(talk_.take_overdue(begin_ + 1h));
  EXPECT_THAT(lines_, ElementsAre(HasSubstr("edge2 answers in place of edge1")));
}

TEST_F(Talk, CloudsTravelAsTheServersReadThem) {
  EXPECT_EQ(talk_.choose_codec(begin_), CloudCodec::draco);
  talk_.heard_server("edge1", {CloudCodec::voxel}, begin_);
  EXPECT_EQ(talk_.choose_codec(begin_), CloudCodec::voxel);
  EXPECT_EQ(talk_.choose_codec(begin_), CloudCodec::voxel);
  EXPECT_THAT(lines_, ElementsAre(HasSubstr("clouds travel as voxel in place of draco")));
  EXPECT_EQ(talk_.choose_codec(begin_ + 1h), CloudCodec::draco) << "the server fell silent";
}

TEST_F(Talk, ANamesakeIsAProblemForTenSecondsAndToldOnce) {
  EXPECT_EQ(talk_.problem(begin_), "");
  for (const auto at : {0s, 5s, 14s}) talk_.namesake_heard(begin_ + at);
  EXPECT_THAT(talk_.problem(begin_ + 23s), HasSubstr("another device asks as robot1"));
  EXPECT_EQ(talk_.problem(begin_ + 25s), "");
  EXPECT_THAT(lines_, SizeIs(1));
  talk_.namesake_heard(begin_ + 60s);
  EXPECT_THAT(lines_, SizeIs(2));
}

}  // namespace
}  // namespace liloc
