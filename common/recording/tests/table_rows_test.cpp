#include "common/recording/table_rows.hpp"

#include <gmock/gmock.h>

#include <random>

namespace liloc {
namespace {

using testing::ElementsAre;
using testing::Pair;

std::vector<std::pair<std::size_t, std::string>> rows(std::string_view text) {
  std::vector<std::pair<std::size_t, std::string>> found;
  EXPECT_TRUE(for_each_row(text, [&](std::size_t number, std::string_view line) -> Status {
    found.emplace_back(number, line);
    return {};
  }));
  return found;
}

TEST(TableRows, CommentsAndEmptyLinesAreCountedAndNotGiven) {
  EXPECT_THAT(rows("#head\n\na\r\n  \nb c  \n#\nlast"),
              ElementsAre(Pair(3, "a"), Pair(5, "b c"), Pair(7, "last")));
  EXPECT_THAT(rows("\xef\xbb\xbf#head\na\n"), ElementsAre(Pair(2, "a")));
  EXPECT_TRUE(rows("").empty());
}

TEST(TableRows, TheFirstErrorEndsThem) {
  int asked = 0;
  const Status done = for_each_row("a\nb\nc\n", [&](std::size_t number, std::string_view) -> Status {
    ++asked;
    return number == 2 ? Status(fail("line {}", number)) : Status{};
  });
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().message, "line 2");
  EXPECT_EQ(asked, 2);
}

TEST(TableRows, CellsArePartedByCommasAndBlanks) {
  std::string_view line = " a,b\t c ,, d ";
  for (const char* cell : {"a", "b", "c", "d", "", ""}) EXPECT_EQ(next_cell(line), cell);
}

TEST(TableRows, TheRestIsExactlyThatManyFiniteNumbers) {
  std::array<double, 2> values{};
  EXPECT_TRUE(parse_rest("1.5, -2e3", values));
  EXPECT_THAT(values, ElementsAre(1.5, -2000));
  for (const char* wrong : {"1", "1,2,3", "1,x", "1,2x", "1,nan", "1,inf", ""})
    EXPECT_FALSE(parse_rest(wrong, values)) << wrong;
}

class SecondsLaw : public testing::TestWithParam<unsigned> {};

TEST_P(SecondsLaw, StampsOfAnySizeComeBackToTheNanosecond) {
  std::mt19937_64 rng(GetParam());
  for (int i = 0; i < 1000; ++i) {
    const auto stamp_ns = static_cast<StampNs>(rng() >> (1 + rng() % 63));
    if (stamp_ns > std::numeric_limits<StampNs>::max() - 2 * kNsInSecond)
      continue;  // the last two seconds are refused
    StampNs back_ns = -1;
    ASSERT_TRUE(parse_seconds(seconds_text(stamp_ns), back_ns)) << seconds_text(stamp_ns);
    ASSERT_EQ(back_ns, stamp_ns);
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, SecondsLaw, testing::Range(1U, 4U));

TEST(Seconds, AreTakenAsTheyAreWrittenAndNothingElse) {
  StampNs stamp_ns = 0;
  for (const auto& [text, expected_ns] : {std::pair{"1700122000.05", 1'700'122'000'050'000'000},
                                          {"7", 7'000'000'000},
                                          {"7.", 7'000'000'000},
                                          {"0.1234567891", 123'456'789}}) {
    EXPECT_TRUE(parse_seconds(text, stamp_ns)) << text;
    EXPECT_EQ(stamp_ns, expected_ns) << text;
  }
  for (const char* wrong : {"", ".5", "-1", "-0.5", "1e9", "1.-5", "1.5.5", "1.5x", "99999999999", "x"})
    EXPECT_FALSE(parse_seconds(wrong, stamp_ns)) << wrong;
}

}  // namespace
}  // namespace liloc
