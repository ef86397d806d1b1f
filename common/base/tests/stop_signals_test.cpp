#include "common/base/stop_signals.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <thread>

namespace liloc {
namespace {

using namespace std::chrono_literals;

TEST(StopSignals, AreTakenOnceAndEndNothing) {
  const StopSignals signals;
  EXPECT_EQ(signals.within(0ms), 0);
  EXPECT_EQ(signals.within(1ms), 0);
  for (const int signal : {SIGINT, SIGTERM}) {
    ASSERT_EQ(kill(getpid(), signal), 0);
    EXPECT_EQ(signals.within(20s), signal);
  }
  EXPECT_EQ(signals.within(0ms), 0);
}

TEST(StopSignals, AreBlockedInLaterThreadsToo) {
  const StopSignals signals;
  std::jthread([] { std::this_thread::sleep_for(1ms); }).join();
  const std::jthread sender([] { kill(getpid(), SIGTERM); });
  EXPECT_EQ(signals.within(20s), SIGTERM);
}

}  // namespace
}  // namespace liloc
