#include "common/command/text.hpp"

#include <gtest/gtest.h>

namespace liloc::command {
namespace {

TEST(Excerpt, IsShortAndPrintable) {
  EXPECT_EQ(excerpt("robot/1"), "robot/1");
  EXPECT_EQ(excerpt("\x1b[2J\n"), "?[2J?");
  EXPECT_EQ(excerpt(std::string(1 << 20, 'x')).size(), 43U);
}

TEST(OneLine, KeepsUtf8AndBothEnds) {
  EXPECT_EQ(one_line("/home/j\xc3\xbcrg: no such file"), "/home/j\xc3\xbcrg: no such file");
  EXPECT_EQ(one_line("a\nb\x1b\x7f"), "a b??");
  EXPECT_EQ(one_line("\xc2\x9b"), "??");  // a control character that UTF-8 writes in two bytes
  const std::string line = one_line("file: " + std::string(1 << 20, 'x') + "; mend it");
  EXPECT_LE(line.size(), 400U);
  EXPECT_TRUE(line.starts_with("file: x"));
  EXPECT_TRUE(line.ends_with("x; mend it"));
}

}  // namespace
}  // namespace liloc::command
