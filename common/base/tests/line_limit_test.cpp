#include "common/base/line_limit.hpp"

#include <gtest/gtest.h>

namespace liloc {
namespace {

using namespace std::chrono_literals;

const LineLimit::Time kStart{1000s};

TEST(LineLimit, OneInFiveSecondsAndTheNextTellsHowManyWereHeldBack) {
  LineLimit limit;
  EXPECT_EQ(limit.pass(kStart), 0U);
  EXPECT_FALSE(limit.pass(kStart + 1s));
  EXPECT_FALSE(limit.pass(kStart + 4s));
  EXPECT_EQ(limit.pass(kStart + 5s), 2U);
}

TEST(SourceLimit, EachSourceSpeaksOnceInFiveSeconds) {
  SourceLimit limit;
  EXPECT_EQ(limit.pass("a", kStart), 0U);
  EXPECT_EQ(limit.pass("b", kStart), 0U);
  EXPECT_FALSE(limit.pass("a", kStart + 1s));
  EXPECT_EQ(limit.pass("a", kStart + 6s), 1U);
}

TEST(SourceLimit, AStrangerOfAThousandNamesCausesFewLines) {
  SourceLimit limit;
  int lines = 0;
  for (int i = 0; i < 10'000; ++i)
    lines += limit.pass(std::to_string(i), kStart + std::chrono::milliseconds(i)).has_value();
  EXPECT_LE(lines, 3 * 16);
}

TEST(HeldBack, SaysHowMany) {
  EXPECT_EQ(held_back(0), "");
  EXPECT_EQ(held_back(3), " (and 3 like it before)");
}

}  // namespace
}  // namespace liloc
