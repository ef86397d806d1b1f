#include "common/wire/dds/dispatcher.hpp"

#include <dds/dds.h>
#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <stdexcept>
#include <thread>

namespace liloc::wire {
namespace {

using namespace std::chrono_literals;
constexpr int kDomain = 122;  // of this test alone

bool eventually(const std::function<bool()>& holds) {
  for (int i = 0; i < 500; ++i, std::this_thread::sleep_for(10ms))
    if (holds()) return true;
  return false;
}

TEST(Guarded, WhatIsThrownGoesNoFurther) {
  guarded([] { throw std::runtime_error("out of something"); });
  bool ran = false;
  guarded([&] { ran = true; });
  EXPECT_TRUE(ran);
}

TEST(Dispatcher, TasksRunOnItsOneThreadUntilItStops) {
  const Participant seat = Participant::create({.domain = kDomain}).value();
  const auto dispatcher = Dispatcher::create(seat).value();
  std::atomic<int> quick = 0, slow = 0;
  std::atomic<bool> alone = true, busy = false;
  const auto count = [&](std::atomic<int>& ticks) {
    if (busy.exchange(true)) alone = false;
    ++ticks;
    std::this_thread::sleep_for(1ms);
    busy = false;
  };
  dispatcher->every(2ms, [&] { count(quick); });
  dispatcher->every(20ms, [&] { count(slow); });
  std::this_thread::sleep_for(30ms);
  EXPECT_EQ(quick, 0) << "not before the start";
  dispatcher->start();
  EXPECT_TRUE(eventually([&] { return slow >= 3; }));
  dispatcher->stop();
  dispatcher->stop();
  const int ended = quick;
  EXPECT_GE(ended, slow);
  std::this_thread::sleep_for(20ms);
  EXPECT_EQ(quick, ended);
  EXPECT_TRUE(alone);
}

TEST(Dispatcher, AConditionIsHandledWhileItIsTriggered) {
  const Participant seat = Participant::create({.domain = kDomain}).value();
  const auto dispatcher = Dispatcher::create(seat).value();
  auto owned = checked(dds_create_guardcondition(seat.handle()), "condition").value();
  const std::int32_t condition = owned.handle();
  std::atomic<int> handled = 0;
  std::vector<Entity> entities;
  entities.push_back(std::move(owned));
  ASSERT_TRUE(dispatcher->attach(condition, std::move(entities), [&] {
    ++handled;
    dds_set_guardcondition(condition, false);
    throw std::runtime_error("out of something");
  }));
  dispatcher->start();
  for (int i = 1; i <= 3; ++i) {
    dds_set_guardcondition(condition, true);
    EXPECT_TRUE(eventually([&] { return handled == i; })) << i;
  }
  EXPECT_EQ(dispatcher->samples_lost(), 0U);
  dispatcher->stop();
}

TEST(Dispatcher, WhatIsNoConditionIsRefused) {
  const Participant seat = Participant::create({.domain = kDomain}).value();
  const auto dispatcher = Dispatcher::create(seat).value();
  EXPECT_FALSE(dispatcher->attach(1, {}, [] {}));
}

}  // namespace
}  // namespace liloc::wire
