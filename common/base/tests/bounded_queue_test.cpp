#include "common/base/bounded_queue.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

namespace liloc {
namespace {

TEST(BoundedQueue, TheOldestMakesRoomAndIsHandedBack) {
  BoundedQueue<int> queue(2);
  EXPECT_EQ(queue.push(1), std::nullopt);
  EXPECT_EQ(queue.push(2), std::nullopt);
  EXPECT_EQ(queue.push(3), 1);
  EXPECT_EQ(queue.try_pop(), 2);
  EXPECT_EQ(queue.try_pop(), 3);
  EXPECT_EQ(queue.try_pop(), std::nullopt);
}

TEST(BoundedQueue, StopDrainsThenEnds) {
  BoundedQueue<int> queue(4);
  std::stop_source stop;
  ASSERT_FALSE(queue.push(1));
  stop.request_stop();
  EXPECT_EQ(queue.pop(stop.get_token()), 1);
  EXPECT_EQ(queue.pop(stop.get_token()), std::nullopt);
}

TEST(BoundedQueue, AClosedQueueGivesTheItemBack) {
  BoundedQueue<int> queue(4);
  queue.close();
  EXPECT_EQ(queue.push(7), 7);
  EXPECT_EQ(queue.pop(std::stop_token{}), std::nullopt);
}

TEST(BoundedQueue, TakesOutWhatIsSuperseded) {
  BoundedQueue<int> queue(4);
  for (int i : {1, 2, 3}) ASSERT_FALSE(queue.push(i));
  EXPECT_EQ(queue.take_if([](int i) { return i == 2; }), 2);
  EXPECT_EQ(queue.take_if([](int i) { return i == 2; }), std::nullopt);
  EXPECT_EQ(queue.size(), 2U);
}

TEST(BoundedQueue, EveryItemIsTakenDisplacedOrLeftExactlyOnce) {
  constexpr int kProducers = 4, kItems = 2000;
  BoundedQueue<int> queue(16);
  std::atomic<int> taken = 0, displaced = 0;
  {
    std::vector<std::jthread> consumers, producers;
    for (int i = 0; i < 2; ++i)
      consumers.emplace_back([&](const std::stop_token& stop) {
        while (queue.pop(stop)) ++taken;
      });
    for (int p = 0; p < kProducers; ++p)
      producers.emplace_back([&] {
        for (int i = 0; i < kItems; ++i)
          if (queue.push(i)) ++displaced;
      });
    producers.clear();
    queue.close();
  }
  EXPECT_EQ(taken + displaced, kProducers * kItems);
}

}  // namespace
}  // namespace liloc
