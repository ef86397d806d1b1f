#include <gtest/gtest.h>

#include "server/service/tests/answers.hpp"

namespace liloc {
namespace {

using namespace std::chrono_literals;
using namespace test;

// Answers clients of which `known_` are verified, one at a time and only once the gate is open.
class Ranked : public testing::Test {
 protected:
  void verify(const std::string& client) {
    gate_.open();
    scheduler_.submit(arrival(client, 1));
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
    scheduler_.stop();
    return {order_.end() - static_cast<std::ptrdiff_t>(answers - verified_), order_.end()};
  }

  Gate gate_;
  Answers answers_;
  std::mutex mutex_;
  std::vector<std::string> order_;
  std::size_t verified_ = 0;
  RequestScheduler scheduler_{
      {.queue = 4}, {.locate = [this](const SpotRequest& r) { return locate(r); }}, answers_.sink()};
};

wire::Arrival lost(const std::string& client, std::uint64_t seq) {
  auto asked = arrival(client, seq);
  asked.request.odom_segment = 7;
  return asked;
}

TEST_F(Ranked, TrackedDevicesComeBeforeSearchesAndKnownOnesBeforeStrangers) {
  for (const char* client : {"tracked", "known"}) verify(client);
  scheduler_.submit(arrival("stranger1", 1));
  gate_.wait_inside();
  scheduler_.submit(arrival("stranger2", 1));
  scheduler_.submit(lost("known", 2));
  scheduler_.submit(arrival("tracked", 2));
  EXPECT_EQ(order_after(6), (std::vector<std::string>{"stranger1", "tracked", "known", "stranger2"}));
}

TEST_F(Ranked, WhoWasServedLongestAgoComesFirst) {
  for (const char* client : {"a", "b", "c"}) verify(client);
  scheduler_.submit(arrival("stranger", 1));
  gate_.wait_inside();
  for (const char* client : {"c", "a", "b"}) scheduler_.submit(arrival(client, 2));
  EXPECT_EQ(order_after(7), (std::vector<std::string>{"stranger", "a", "b", "c"}));
}

TEST_F(Ranked, AFullQueueRefusesStrangersBeforeAnyoneElse) {
  for (const char* client : {"tracked", "known"}) verify(client);
  scheduler_.submit(arrival("stranger", 1));
  gate_.wait_inside();
  scheduler_.submit(arrival("tracked", 2));
  scheduler_.submit(lost("known", 2));
  for (int i = 0; i < 500; ++i) scheduler_.submit(arrival("flood" + std::to_string(i), 1));
  gate_.open();
  ASSERT_TRUE(answers_.wait_for(505));
  EXPECT_EQ(answers_.reason("tracked", 2), Reason::confirmed);
  EXPECT_EQ(answers_.reason("known", 2), Reason::confirmed);
  EXPECT_EQ(answers_.count(Reason::overloaded), 498U);
}

}  // namespace
}  // namespace liloc
