#include "server/service/sessions.hpp"

#include <gtest/gtest.h>

#include "server/service/tests/answers.hpp"

namespace liloc {
namespace {

using namespace std::chrono_literals;
using namespace test;

class RateLimitLaw : public testing::TestWithParam<double> {};

TEST_P(RateLimitLaw, LetsItsRateThroughAndASecondsWorthAtOnce) {
  const double rate_hz = GetParam();
  RateLimit limit(rate_hz);
  const auto start = std::chrono::steady_clock::now();
  int passed = 0;
  for (auto t = 0ms; t < 10s; t += 1ms) passed += limit.admit(start + t) ? 1 : 0;
  EXPECT_LE(passed, 10 * rate_hz + std::max(rate_hz, 1.0));
  EXPECT_GE(passed, 10 * rate_hz - 1);
}
INSTANTIATE_TEST_SUITE_P(Rates, RateLimitLaw, testing::Values(0.5, 1.0, 20.0, 300.0));

TEST(RateLimit, AClockThatGoesBackEarnsNothing) {
  RateLimit limit(2);
  const auto now = std::chrono::steady_clock::now();
  EXPECT_TRUE(limit.admit(now));
  EXPECT_TRUE(limit.admit(now));
  EXPECT_FALSE(limit.admit(now - 1h));
  EXPECT_FALSE(limit.admit(now - 1h));
}

/// A session that asked and was answered.
void exchange(Sessions& sessions, const wire::Arrival& asked, bool is_verified) {
  EXPECT_TRUE(sessions.admit(asked));
  (void)sessions.begins(asked.from);
  sessions.answered(asked,
                    is_verified ? verified(asked.request) : refusal(asked.request, Reason::not_found, ""));
}

TEST(Sessions, AClientStandsByWhatItWasLastAnsweredAndItsSegment) {
  Sessions sessions(100);
  EXPECT_EQ(sessions.waiting(arrival("a", 1)).standing, Standing::stranger);
  exchange(sessions, arrival("a", 1), false);
  EXPECT_EQ(sessions.waiting(arrival("a", 2)).standing, Standing::stranger);
  exchange(sessions, arrival("a", 2), true);
  EXPECT_EQ(sessions.waiting(arrival("a", 3)).standing, Standing::tracked);
  auto broken = arrival("a", 3), cold = arrival("a", 3);
  broken.request.odom_segment = 1;
  cold.request.cold = true;
  EXPECT_EQ(sessions.waiting(broken).standing, Standing::known);
  EXPECT_EQ(sessions.waiting(cold).standing, Standing::known);
  exchange(sessions, arrival("a", 3), false);
  EXPECT_EQ(sessions.waiting(arrival("a", 4)).standing, Standing::known) << "it was verified once";
  sessions.forget_client("a");
  EXPECT_EQ(sessions.waiting(arrival("a", 4)).standing, Standing::stranger);
}

TEST(Sessions, ANewRunBeginsAnewButKeepsItsName) {
  Sessions sessions(100);
  exchange(sessions, arrival("a", 5, 1), true);
  EXPECT_FALSE(sessions.begins(arrival("a", 6, 1).from)) << "the same run goes on";
  const auto anew = arrival("a", 1, 2);
  EXPECT_TRUE(sessions.begins(anew.from));
  EXPECT_FALSE(sessions.is_late(anew.from, 1)) << "what the run before was answered does not count";
  EXPECT_EQ(sessions.waiting(anew).standing, Standing::known);
  EXPECT_FALSE(sessions.is_current(arrival("a", 6, 1).from));
}

TEST(Sessions, LateIsByTheWritersOwnRequests) {
  Sessions sessions(100);
  exchange(sessions, arrival("a", 5), true);
  EXPECT_TRUE(sessions.is_late(arrival("a", 5).from, 5));
  EXPECT_FALSE(sessions.is_late(arrival("a", 6).from, 6));
  EXPECT_FALSE(sessions.is_late(arrival("b", 5).from, 5));
  sessions.forget_publication(arrival("a", 5).from.publication);
  EXPECT_FALSE(sessions.is_late(arrival("a", 5).from, 5));
}

TEST(Sessions, CountsClientsByTheirLastAnswer) {
  Sessions sessions(100);
  for (const char* client : {"a", "b"}) exchange(sessions, arrival(client, 1), true);
  exchange(sessions, arrival("c", 1), false);
  EXPECT_EQ(sessions.clients(SpotStatus::verified), 2U);
  EXPECT_EQ(sessions.clients(SpotStatus::refused), 1U);
  exchange(sessions, arrival("a", 2), false);
  EXPECT_EQ(sessions.clients(SpotStatus::verified), 1U);
}

}  // namespace
}  // namespace liloc
