#include "client/session/server_choice.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

using namespace std::chrono_literals;

constexpr ServerChoice::Time kStart{1000s};

/// Where the time does not matter: all at once.
struct Choice : ServerChoice {
  [[nodiscard]] bool takes(const SpotReply& reply, Time now = kStart) {
    return ServerChoice::takes(reply, now);
  }
};

SpotReply from(const char* server, std::uint64_t seq, SpotStatus status = SpotStatus::verified) {
  SpotReply reply;
  reply.server_id = server;
  reply.seq = seq;
  reply.status = status;
  return reply;
}

TEST(ServerChoice, OneServerIsAlwaysTaken) {
  Choice choice;
  for (const std::uint64_t seq : {1, 2, 9, 5, 5, 10}) EXPECT_TRUE(choice.takes(from("edge1", seq))) << seq;
  EXPECT_TRUE(choice.takes(from("edge1", 11, SpotStatus::refused)));
}

TEST(ServerChoice, OfTwoThatAnswerTheFirstIsFollowedWhicheverIsQuicker) {
  Choice choice;
  EXPECT_TRUE(choice.takes(from("edge1", 1)));
  EXPECT_FALSE(choice.takes(from("edge2", 1)));
  for (std::uint64_t seq = 2; seq < 20; ++seq) {
    EXPECT_FALSE(choice.takes(from("edge2", seq)));
    EXPECT_TRUE(choice.takes(from("edge1", seq)));
  }
  EXPECT_EQ(choice.followed(), "edge1");
}

TEST(ServerChoice, TheSecondRequestWithoutAnAnswerIsTheStandbys) {
  for (const SpotStatus status : {SpotStatus::verified, SpotStatus::provisional, SpotStatus::refused}) {
    Choice choice;
    EXPECT_TRUE(choice.takes(from("edge1", 7, status)));
    EXPECT_FALSE(choice.takes(from("edge2", 7, status)));
    EXPECT_FALSE(choice.takes(from("edge2", 8, status)));
    EXPECT_TRUE(choice.takes(from("edge2", 9, status)));
    EXPECT_TRUE(choice.takes(from("edge2", 10, status)));
    EXPECT_FALSE(choice.takes(from("edge1", 11, status)));  // it is back: no reason to change again
    EXPECT_TRUE(choice.takes(from("edge2", 11, status)));
  }
}

TEST(ServerChoice, WhoVerifiesIsPreferredToWhoOnlyAnswers) {
  Choice choice;
  EXPECT_TRUE(choice.takes(from("edge1", 1)));
  EXPECT_TRUE(choice.takes(from("edge1", 2, SpotStatus::refused)));  // its LiDARs are gone
  EXPECT_FALSE(choice.takes(from("edge2", 2)));
  EXPECT_TRUE(choice.takes(from("edge1", 3, SpotStatus::refused)));
  EXPECT_FALSE(choice.takes(from("edge3", 3, SpotStatus::provisional)));
  EXPECT_TRUE(choice.takes(from("edge2", 3)));
  EXPECT_FALSE(choice.takes(from("edge1", 4, SpotStatus::refused)));
}

TEST(ServerChoice, WhatTheFollowedOneLeavesUnansweredIsTheStandbysAfterAMoment) {
  Choice choice;
  EXPECT_TRUE(choice.takes(from("edge1", 1)));
  EXPECT_FALSE(choice.takes(from("edge2", 1)));
  EXPECT_FALSE(choice.take_overdue(kStart + 1h)) << "it was answered";
  EXPECT_FALSE(choice.takes(from("edge2", 2), kStart));
  EXPECT_FALSE(choice.take_overdue(kStart + 50ms));
  const auto taken = choice.take_overdue(kStart + 150ms);
  ASSERT_TRUE(taken);
  EXPECT_EQ(taken->seq, 2U);
  EXPECT_EQ(choice.followed(), "edge2");
  EXPECT_FALSE(choice.take_overdue(kStart + 1h)) << "once";
  EXPECT_FALSE(choice.takes(from("edge1", 2), kStart + 200ms)) << "what comes too late counts no longer";
}

TEST(ServerChoice, OnlyWhatIsVerifiedIsTakenBeforeTheSecondRequest) {
  Choice choice;
  EXPECT_TRUE(choice.takes(from("edge1", 1)));
  EXPECT_FALSE(choice.takes(from("edge2", 2, SpotStatus::provisional)));
  EXPECT_FALSE(choice.take_overdue(kStart + 1h));
}

TEST(ServerChoice, AnAnswerInTimeKeepsTheFollowedOneWhateverItSays) {
  for (const SpotStatus status : {SpotStatus::verified, SpotStatus::provisional, SpotStatus::refused}) {
    Choice choice;
    EXPECT_TRUE(choice.takes(from("edge1", 1)));
    EXPECT_FALSE(choice.takes(from("edge2", 2), kStart));
    EXPECT_TRUE(choice.takes(from("edge1", 2, status), kStart + 60ms));
    EXPECT_FALSE(choice.take_overdue(kStart + 1h));
  }
}

TEST(ServerChoice, OneThatIsAlwaysSlowerIsGivenTheTimeThatItTakes) {
  Choice choice;
  EXPECT_TRUE(choice.takes(from("edge1", 1)));
  for (std::uint64_t seq = 2; seq < 20; ++seq) {
    const auto asked = kStart + std::chrono::seconds(seq);
    EXPECT_FALSE(choice.takes(from("edge2", seq), asked));
    EXPECT_FALSE(choice.take_overdue(asked + 90ms)) << seq;
    if (seq > 2) {
      EXPECT_FALSE(choice.take_overdue(asked + 150ms)) << seq;
    }
    EXPECT_TRUE(choice.takes(from("edge1", seq), asked + (seq > 2 ? 160ms : 95ms)));
  }
  const auto asked = kStart + 20s;
  EXPECT_FALSE(choice.takes(from("edge2", 20), asked));
  EXPECT_FALSE(choice.take_overdue(asked + 200ms));
  EXPECT_TRUE(choice.take_overdue(asked + 400ms)) << "not for ever";
}

}  // namespace
}  // namespace liloc
