#include "common/base/log.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace liloc::log {
namespace {

TEST(Log, LevelsHaveTheirNames) {
  EXPECT_EQ(*level_from("debug"), Level::debug);
  EXPECT_EQ(*level_from("info"), Level::info);
  EXPECT_EQ(*level_from("warning"), Level::warning);
  EXPECT_EQ(*level_from("error"), Level::error);
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

}  // namespace
}  // namespace liloc::log
