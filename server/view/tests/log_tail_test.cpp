#include "server/view/log_tail.hpp"

#include <gtest/gtest.h>

namespace liloc::view {
namespace {

TEST(LogTail, KeepsTheLastHundredLines) {
  LogTail tail;
  for (int i = 0; i < 250; ++i) tail.add(log::Level::info, std::to_string(i));
  const auto lines = tail.lines();
  ASSERT_EQ(lines.size(), 100U);
  EXPECT_EQ(lines.front().text, "150");
  EXPECT_EQ(lines.back().text, "249");
  EXPECT_EQ(tail.count(), 250U);
}

TEST(LogTail, LongLinesAreCut) {
  LogTail tail;
  tail.add(log::Level::error, std::string(5000, 'x'));
  const auto line = tail.lines().front();
  EXPECT_EQ(line.text.size(), 300U);
  EXPECT_TRUE(line.text.ends_with("x..."));
  EXPECT_EQ(line.level, log::Level::error);
}

}  // namespace
}  // namespace liloc::view
