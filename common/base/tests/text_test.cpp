#include "common/base/text.hpp"

#include <gtest/gtest.h>

#include <random>

namespace liloc {
namespace {

TEST(WithoutControls, TextStaysAsItWas) {
  for (const char* text : {"", "robot1",
                           "B\xc3\xb6 5 \xc2\xb0"
                           "C",
                           "\xe6\x97\xa5\xe6\x9c\xac", "\xf0\x9f\xa4\x96"})
    EXPECT_EQ(without_controls(text), text);
}

TEST(WithoutControls, EachByteOfAControlCharacterIsShown) {
  EXPECT_EQ(without_controls("a\nb\tc\rd"), "a b?c?d");
  EXPECT_EQ(without_controls("\x1b[2J\x7f"), "?[2J?");
  EXPECT_EQ(without_controls({"a\0b", 3}), "a?b");
  EXPECT_EQ(without_controls("\xc2\x80 \xc2\x9f"), "?? ??") << "control characters of two bytes";
  EXPECT_EQ(without_controls("\xc2\xa0"), "\xc2\xa0") << "the first that is none";
  EXPECT_EQ(without_controls("a\xc2"), "a\xc2") << "cut off";
}

TEST(WithoutControls, NothingOfRandomBytesIsLeftThatSteersATerminal) {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> byte(0, 255);
  for (int i = 0; i < 2000; ++i) {
    std::string text(12, ' ');
    for (char& c : text) c = static_cast<char>(byte(random));
    const std::string shown = without_controls(text);
    ASSERT_EQ(shown.size(), text.size());
    EXPECT_EQ(without_controls(shown), shown) << "once is enough";
    for (const char c : shown) EXPECT_TRUE(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f);
  }
}

}  // namespace
}  // namespace liloc
