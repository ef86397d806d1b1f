#include "proto-tests/replay/processes.hpp"

#include <gmock/gmock.h>

#include <csignal>
#include <thread>

#include "proto-tests/replay/tests/temp_folder.hpp"

namespace liloc::replay {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

struct ChildTest : testing::Test {
  Result<Child> shell(const std::string& script) { return Child::start({"/bin/sh", "-c", script}, log_); }
  void wait_for_line() {
    for (int i = 0; i < 500 && last_lines(log_, 1).empty(); ++i) std::this_thread::sleep_for(milliseconds(10));
  }
  TempFolder folder_;
  std::filesystem::path log_ = folder_.path() / "log";
};

TEST_F(ChildTest, OneThatEndsWellIsNoError) {
  auto child = shell("echo done");
  ASSERT_TRUE(child);
  while (child->running()) std::this_thread::sleep_for(milliseconds(5));
  EXPECT_TRUE(child->stop());
  EXPECT_EQ(last_lines(log_, 3), "done");
}

TEST_F(ChildTest, TellsWhatItUsed) {
  auto child = shell("i=0; while [ $i -lt 100000 ]; do i=$((i+1)); done");
  ASSERT_TRUE(child);
  EXPECT_EQ(child->usage().peak_mb, 0);
  while (child->running()) std::this_thread::sleep_for(milliseconds(5));
  EXPECT_TRUE(child->stop());
  EXPECT_GT(child->usage().cpu_s, 0);
  EXPECT_GT(child->usage().peak_mb, 0.1);
  EXPECT_LT(child->usage().peak_mb, 100);
}

TEST_F(ChildTest, AFailureCarriesItsLastLines) {
  auto child = shell("echo one; echo two >&2; echo three; echo four; exit 7");
  ASSERT_TRUE(child);
  while (child->running()) std::this_thread::sleep_for(milliseconds(5));
  const auto status = child->stop();
  ASSERT_FALSE(status);
  EXPECT_THAT(status.error().message, HasSubstr("exit code 7"));
  EXPECT_THAT(status.error().message, HasSubstr("two | three | four"));
}

TEST_F(ChildTest, OneThatIgnoresTheRequestIsKilled) {
  auto child = shell("trap '' TERM; echo deaf; while :; do sleep 0.05; done");
  ASSERT_TRUE(child);
  wait_for_line();
  const auto status = child->stop(milliseconds(200));
  ASSERT_FALSE(status);
  EXPECT_THAT(status.error().message, HasSubstr("signal 9"));
}

TEST_F(ChildTest, TheDestructorLeavesNoProcessBehind) {
  {
    auto child = shell("echo $$; exec sleep 60");
    ASSERT_TRUE(child);
    wait_for_line();
  }
  const pid_t pid = std::stoi(last_lines(log_, 1));
  EXPECT_EQ(kill(pid, 0), -1) << "process " << pid << " still stands";
}

TEST_F(ChildTest, AMissingProgramIsNamed) {
  const auto child = Child::start({"/no/such/liloc-server"}, log_);
  ASSERT_FALSE(child);
  EXPECT_THAT(child.error().message, HasSubstr("/no/such/liloc-server"));
}

TEST(FreeDomain, IsInTheRangeOfSafePorts) {
  const auto domain = free_domain();
  ASSERT_TRUE(domain) << domain.error().message;
  EXPECT_GE(*domain, 60);
  EXPECT_LT(*domain, 100);
}

}  // namespace
}  // namespace liloc::replay
