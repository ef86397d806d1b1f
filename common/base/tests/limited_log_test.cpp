#include "common/base/limited_log.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace liloc {
namespace {

TEST(LimitedLog, TellsOnceWhatIsRepeated) {
  std::vector<std::string> lines;
  log::set_sink([&](log::Level level, std::string_view line) {
    EXPECT_EQ(level, log::Level::warning);
    lines.emplace_back(line);
  });
  LineLimit limit, other;
  for (int i = 0; i < 100; ++i) log::limited(limit, "{} m in {} s", i, 0.02);
  log::limited(other, "another line");
  log::set_sink({});
  ASSERT_EQ(lines.size(), 2U);
  EXPECT_EQ(lines[0], "0 m in 0.02 s");
  EXPECT_EQ(lines[1], "another line");
}

}  // namespace
}  // namespace liloc
