#include "proto-tests/soak/process_figures.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <unistd.h>

#include <csignal>
#include <future>
#include <thread>
#include <vector>

#include "proto-tests/load/forked.hpp"
#include "proto-tests/soak/report.hpp"

namespace liloc::soak {
namespace {

TEST(ProcessFigures, MemoryThreadsAndDescriptorsOfThisProcessShow) {
  const auto before = figures_of(getpid());
  ASSERT_TRUE(before) << before.error().message;
  EXPECT_GT(before->memory_mb, 0);
  std::vector<char> bytes(50'000'000, 'x');
  const int file = open("/dev/null", O_RDONLY | O_CLOEXEC);
  ASSERT_GE(file, 0);
  std::promise<void> end;
  std::thread thread([done = end.get_future()] { done.wait(); });
  const auto after = figures_of(getpid());
  end.set_value();
  thread.join();
  close(file);
  ASSERT_TRUE(after) << after.error().message;
  EXPECT_NEAR(after->memory_mb - before->memory_mb, 50, 5);
  EXPECT_EQ(after->threads, before->threads + 1);
  EXPECT_EQ(after->descriptors, before->descriptors + 1);
  EXPECT_EQ(bytes.back(), 'x');
}

TEST(ProcessFigures, WhoHasEndedHasNone) {
  auto forked = load::Forked::start([]() -> Result<std::string> { return "done"; });
  ASSERT_TRUE(forked);
  const pid_t pid = forked->pid();
  ASSERT_TRUE(forked->collect());
  const auto figures = figures_of(pid);
  ASSERT_FALSE(figures);
  EXPECT_THAT(figures.error().message, testing::HasSubstr("has ended"));
}

/// Grows until it is killed.
Result<std::string> leak() {
  std::vector<std::vector<char>> kept;
  for (;;) {
    kept.emplace_back(1'000'000, 'x');
    if (open("/dev/null", O_RDONLY) < 0) return fail("no further descriptor");
    if (kept.size() % 10 == 0) std::thread(pause).detach();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

/// However busy the machine is; ten seconds at most.
void wait_for_mb(pid_t pid, double memory_mb) {
  for (int i = 0; i < 1000; ++i) {
    const auto figures = figures_of(pid);
    if (!figures || figures->memory_mb >= memory_mb) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

TEST(ProcessFigures, AProcessThatLeaksFailsTheSoak) {
  auto forked = load::Forked::start(leak);
  ASSERT_TRUE(forked);
  Watched watched{"leak", 8, {}, {}, {}};
  for (int i = 0; i < 40; ++i) {
    const auto figures = figures_of(forked->pid());
    ASSERT_TRUE(figures) << figures.error().message;
    const double at_s = 5.0 * i;  // as if it leaked a hundred times slower, for over three minutes
    watched.memory_mb.push_back({at_s, figures->memory_mb});
    watched.threads.push_back({at_s, static_cast<double>(figures->threads)});
    watched.descriptors.push_back({at_s, static_cast<double>(figures->descriptors)});
    wait_for_mb(forked->pid(), figures->memory_mb + 5);
  }
  SoakReport report;
  report.answered = 1;
  report.processes.push_back(summarize(watched, 0));
  judge(report);
  EXPECT_THAT(report.failures, testing::ElementsAre(testing::StartsWith("leak: memory grew"),
                                                    testing::StartsWith("leak: threads grew"),
                                                    testing::StartsWith("leak: descriptors grew")));
}

}  // namespace
}  // namespace liloc::soak
