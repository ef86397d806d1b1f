#include "client/session/server_choice.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

SpotReply from(const char* server, std::uint64_t seq, SpotStatus status = SpotStatus::verified) {
  SpotReply reply;
  reply.server_id = server;
  reply.seq = seq;
  reply.status = status;
  return reply;
}

TEST(ServerChoice, OneServerIsAlwaysTaken) {
  ServerChoice choice;
  for (const std::uint64_t seq : {1, 2, 9, 5, 5, 10}) EXPECT_TRUE(choice.takes(from("edge1", seq))) << seq;
  EXPECT_TRUE(choice.takes(from("edge1", 11, SpotStatus::refused)));
}

TEST(ServerChoice, OfTwoThatAnswerTheFirstIsFollowedWhicheverIsQuicker) {
  ServerChoice choice;
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
    ServerChoice choice;
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
  ServerChoice choice;
  EXPECT_TRUE(choice.takes(from("edge1", 1)));
  EXPECT_TRUE(choice.takes(from("edge1", 2, SpotStatus::refused)));  // its LiDARs are gone
  EXPECT_FALSE(choice.takes(from("edge2", 2)));
  EXPECT_TRUE(choice.takes(from("edge1", 3, SpotStatus::refused)));
  EXPECT_FALSE(choice.takes(from("edge3", 3, SpotStatus::provisional)));
  EXPECT_TRUE(choice.takes(from("edge2", 3)));
  EXPECT_FALSE(choice.takes(from("edge1", 4, SpotStatus::refused)));
}

}  // namespace
}  // namespace liloc
