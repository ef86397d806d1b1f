#include "common/wire/spots/reply_writers.hpp"

#include <gtest/gtest.h>

#include <thread>

#include "common/wire/spots/tests/ends.hpp"

namespace liloc::wire {
namespace {

constexpr int kDomain = 118;  // of the tests of this room alone

TEST(ReplyWriters, AClientIsNewOnceAndGoneWhenClosed) {
  const Participant seat = Participant::create({.domain = kDomain, .role = Role::server}).value();
  ReplyWriters writers(seat.handle(), 2);
  EXPECT_TRUE(writers.open("robot1").value());
  EXPECT_FALSE(writers.open("robot1").value());
  EXPECT_EQ(writers.clients(), 1U);
  EXPECT_TRUE(writers.write("robot1", to_wire(sample_reply(), 1)));
  writers.close("robot1");
  writers.close("robot1");
  EXPECT_EQ(writers.clients(), 0U);
  const auto late = writers.write("robot1", to_wire(sample_reply(), 1));
  ASSERT_FALSE(late);
  EXPECT_NE(late.error().message.find("robot1 has left"), std::string::npos);
}

TEST(ReplyWriters, MoreThanTheLimitAreRefusedUntilOneLeaves) {
  const Participant seat = Participant::create({.domain = kDomain, .role = Role::server}).value();
  ReplyWriters writers(seat.handle(), 2);
  EXPECT_TRUE(writers.open("robot1"));
  EXPECT_TRUE(writers.open("robot2"));
  const auto third = writers.open("robot3");
  ASSERT_FALSE(third);
  EXPECT_NE(third.error().message.find("2 clients are the limit"), std::string::npos);
  EXPECT_TRUE(writers.open("robot2")) << "who is served stays so";
  writers.close("robot1");
  EXPECT_TRUE(writers.open("robot3"));
}

TEST(ReplyWriters, WorkersWriteWhileClientsComeAndGo) {
  const Participant seat = Participant::create({.domain = kDomain, .role = Role::server}).value();
  ReplyWriters writers(seat.handle(), 8);
  ASSERT_TRUE(writers.open("robot0"));
  std::atomic<int> written = 0;
  {
    std::vector<std::jthread> workers;
    for (int i = 0; i < 3; ++i)
      workers.emplace_back([&](const std::stop_token& stop) {
        while (!stop.stop_requested())
          if (writers.write("robot0", to_wire(sample_reply(), 1))) ++written;
      });
    for (int i = 0; i < 50; ++i) {
      ASSERT_TRUE(writers.open("robot1"));
      writers.close("robot1");
    }
  }
  EXPECT_GT(written, 0);
  EXPECT_EQ(writers.clients(), 1U);
}

}  // namespace
}  // namespace liloc::wire
