#include "common/base/log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <future>
#include <thread>

#include "common/base/log_level.hpp"

namespace liloc::log {
namespace {

TEST(Log, LevelsHaveTheirNames) {
  EXPECT_EQ(*level_from("debug"), Level::debug);
  EXPECT_EQ(*level_from("info"), Level::info);
  EXPECT_EQ(*level_from("warning"), Level::warning);
  EXPECT_EQ(*level_from("error"), Level::error);
  EXPECT_STREQ(name_of(Level::warning), "warning");
  EXPECT_THAT(level_from("Warn").error().message, testing::HasSubstr("'Warn'"));
}

TEST(Log, LinesGoWhereTheProgramSays) {
  std::vector<std::string> lines;
  warning("nobody listens");
  set_sink([&](Level level, std::string_view line) {
    lines.push_back(fmt::format("{} {}", static_cast<int>(level), line));
  });
  warning("{} of {}", 1, 2);
  set_sink({});
  error("nobody listens any more");
  EXPECT_THAT(lines, testing::ElementsAre("2 1 of 2"));
}

TEST(Log, NoCallOfASinkOutlivesIt) {
  std::promise<void> entered;
  std::atomic<bool> left = false;
  set_sink([&](Level, std::string_view) {
    entered.set_value();
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    left = true;
  });
  std::jthread writer([] { warning("slow"); });
  entered.get_future().wait();
  set_sink({});
  EXPECT_TRUE(left);
}

TEST(Log, ASinkMayReplaceItself) {
  int called = 0;
  set_sink([&](Level, std::string_view) {
    ++called;
    set_sink({});
  });
  warning("once");
  warning("nobody listens any more");
  EXPECT_EQ(called, 1);
}

TEST(Log, NoControlCharacterReachesTheSink) {
  std::vector<std::string> lines;
  set_sink([&](Level, std::string_view line) { lines.emplace_back(line); });
  warning("{} is here", "\x1b[2Jedge1\n2026-01-01 forged \xc2\x9b\x7f B\xc3\xb6");
  set_sink({});
  EXPECT_THAT(lines, testing::ElementsAre("?[2Jedge1 2026-01-01 forged ??"
                                          "? B\xc3\xb6 is here"));
}

}  // namespace
}  // namespace liloc::log
