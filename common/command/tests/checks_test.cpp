#include "common/command/checks.hpp"

#include <gmock/gmock.h>

namespace liloc::command {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

std::string said(const CLI::Validator& check, std::string given) {
  return check(given);
}

TEST(Checks, ANumberIsFiniteAndInRange) {
  for (const char* good : {"0.01", "+0.2", "5e-1"})
    EXPECT_THAT(said(number_within(0.01, 0.5), good), IsEmpty());
  for (const char* bad :
       {"nan", "NaN", "inf", "-inf", "1e999", "0.009", "0.6", "", "0.1m", "0,1", " 0.1", "0x1"})
    EXPECT_THAT(said(number_within(0.01, 0.5), bad), HasSubstr("give a number in 0.01..0.5")) << bad;
}

TEST(Checks, AWholeNumberIsWhole) {
  EXPECT_THAT(said(in_range(1, 64), "64"), IsEmpty());
  for (const char* bad : {"0", "65", "1.5", "nan", "many", "99999999999999999999", "-1"})
    EXPECT_THAT(said(in_range(1, 64), bad), HasSubstr("give a whole number in 1..64")) << bad;
  EXPECT_THAT(said(any_seed(), "18446744073709551615"), IsEmpty());
  EXPECT_THAT(said(any_seed(), "-1"), HasSubstr("from 0"));
}

TEST(Checks, OnlyAnExcerptIsShown) {
  const std::string hostile = "\x1b[2J" + std::string(1 << 20, 'x');
  for (const auto& check :
       {finite(), any_seed(), an_id(), one_of({"a", "b"}), in_range(0, 1), in_range(0.0, 1.0)}) {
    const std::string text = said(check, hostile);
    EXPECT_FALSE(text.empty());
    EXPECT_LT(text.size(), 120U);
    EXPECT_EQ(text.find('\x1b'), std::string::npos);
  }
}

TEST(Checks, LettersBetweenIsADistance) {
  EXPECT_EQ(letters_between("voxle", "voxel"), 2U);
  EXPECT_EQ(letters_between("workrs", "workers"), 1U);
  EXPECT_EQ(letters_between("", "abc"), 3U);
  EXPECT_EQ(letters_between("seed", "seed"), 0U);
}

}  // namespace
}  // namespace liloc::command
