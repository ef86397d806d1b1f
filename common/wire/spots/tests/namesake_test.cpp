#include "common/wire/spots/namesake.hpp"

#include <gtest/gtest.h>

namespace liloc::wire {
namespace {

using namespace std::chrono_literals;

TEST(Namesake, LivesWhenItGoesOnAskingAfterWhatWasLeft) {
  Namesake namesake;
  const auto start = Namesake::Time{} + 1h;
  for (std::uint64_t seq = 1; seq <= 8; ++seq)
    EXPECT_FALSE(namesake.lives(77, seq, start + 10ms));  // kept ones
  EXPECT_FALSE(namesake.lives(77, 8, start + 5s)) << "the same answer again, from a standby";
  EXPECT_TRUE(namesake.lives(77, 9, start + 6s));
  EXPECT_FALSE(namesake.lives(78, 10, start + 7s)) << "another run that may have ended";
  EXPECT_TRUE(namesake.lives(78, 11, start + 10s));
}

TEST(Namesake, LivesAmongSeveral) {
  Namesake namesake;
  const auto start = Namesake::Time{} + 1h;
  int told = 0;
  for (std::uint64_t seq = 1; seq <= 10; ++seq)
    for (const std::uint64_t session : {77U, 78U})
      told += namesake.lives(session, seq, start + seq * 1s) ? 1 : 0;
  EXPECT_EQ(told, 14) << "from the fourth answer of each on";
}

}  // namespace
}  // namespace liloc::wire
