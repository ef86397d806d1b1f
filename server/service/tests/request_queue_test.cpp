#include "server/service/request_queue.hpp"

#include <gtest/gtest.h>

#include "server/service/tests/answers.hpp"

namespace liloc {
namespace {

using namespace std::chrono_literals;
using namespace test;

Waiting waiting(const std::string& client, Standing standing) {
  return {arrival(client, 1), standing, std::chrono::steady_clock::now()};
}

TEST(RequestQueue, SearchesGetTheirShareThoughTrackedDevicesNeverCease) {
  RequestQueue queue(16);
  std::chrono::milliseconds searching{0}, tracking{0};
  for (const auto* busy : {"a", "b"}) ASSERT_FALSE(queue.push(waiting(busy, Standing::tracked)));
  for (const auto* lost : {"x", "y"}) ASSERT_FALSE(queue.push(waiting(lost, Standing::known)));
  while (tracking + searching < 20s) {
    auto begun = queue.begin();
    ASSERT_TRUE(begun);
    const auto took = begun->searches() ? 50ms : 4ms;
    (begun->searches() ? searching : tracking) += took;
    queue.end(*begun, took);
    ASSERT_FALSE(queue.push(waiting(begun->arrival.from.client_id, begun->standing)));
  }
  EXPECT_GT(searching, 4s);
  EXPECT_LT(searching, 6s);
}

TEST(RequestQueue, WorkersThatAskAtOnceDoNotAllBeginSearches) {
  RequestQueue queue(32);
  for (int i = 0; i < 4; ++i) ASSERT_FALSE(queue.push(waiting(fmt::format("lost{}", i), Standing::known)));
  for (int i = 0; i < 31; ++i) {  // 124 ms of tracked work: one search of 40 ms is owed, and no second one
    ASSERT_FALSE(queue.push(waiting("busy", Standing::tracked)));
    auto begun = queue.begin();
    ASSERT_TRUE(begun && !begun->searches());
    queue.end(*begun, 4ms);
  }
  int searching = 0;
  for (int i = 0; i < 4; ++i) {
    ASSERT_FALSE(queue.push(waiting(fmt::format("busy{}", i), Standing::tracked)));
    searching += queue.begin()->searches() ? 1 : 0;
  }
  EXPECT_EQ(searching, 1);
}

TEST(RequestQueue, LongSearchesGetNoMoreThanTheirShare) {
  RequestQueue queue(16);
  std::chrono::milliseconds searching{0}, tracking{0};
  ASSERT_FALSE(queue.push(waiting("busy", Standing::tracked)));
  ASSERT_FALSE(queue.push(waiting("lost", Standing::known)));
  while (tracking + searching < 20s) {
    auto begun = queue.begin();
    ASSERT_TRUE(begun);
    const auto took = begun->searches() ? 150ms : 4ms;
    (begun->searches() ? searching : tracking) += took;
    queue.end(*begun, took);
    ASSERT_FALSE(queue.push(waiting(begun->arrival.from.client_id, begun->standing)));
  }
  EXPECT_GT(searching, 4s);
  EXPECT_LT(searching, 6s);
}

TEST(RequestQueue, SearchesGetAllTheTimeThatNobodyElseWants) {
  RequestQueue queue(16);
  for (int i = 0; i < 10; ++i) {
    ASSERT_FALSE(queue.push(waiting("x", Standing::stranger)));
    auto begun = queue.begin();
    ASSERT_TRUE(begun);
    queue.end(*begun, 50ms);
  }
}

}  // namespace
}  // namespace liloc
