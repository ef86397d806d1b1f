#include "common/wire/dds/log_sink.hpp"

#include <dds/dds.h>
#include <dds/ddsrt/log.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "common/base/log.hpp"

namespace liloc::wire {
namespace {

struct Line {
  log::Level level;
  std::string text;
};

void say(std::uint32_t category, const std::string& text) {
  dds_log(category, __FILE__, __LINE__, __func__, "%s\n", text.c_str());
}

// One test, as what was told within five seconds is remembered by the process.
TEST(LogSink, EachTextComesOnceWithItsLevelAndSixteenInAll) {
  std::vector<Line> lines;
  install_log_sink();
  install_log_sink();
  log::set_sink([&](log::Level level, std::string_view line) { lines.push_back({level, std::string(line)}); });
  say(DDS_LC_ERROR, "cannot open the port");
  say(DDS_LC_WARNING, "a sample is damaged");
  say(DDS_LC_INFO, "all is well");
  for (int i = 0; i < 1000; ++i) say(DDS_LC_WARNING, "a sample is damaged");
  for (int i = 0; i < 100; ++i) say(DDS_LC_WARNING, "a stranger knocks as number " + std::to_string(i));
  log::set_sink({});
  ASSERT_GE(lines.size(), 2U);
  EXPECT_LE(lines.size(), 16U);
  EXPECT_EQ(lines[0].level, log::Level::error);
  EXPECT_EQ(lines[0].text, "dds: cannot open the port");
  EXPECT_EQ(lines[1].level, log::Level::warning);
  EXPECT_EQ(lines[1].text, "dds: a sample is damaged");
  for (std::size_t i = 2; i < lines.size(); ++i) EXPECT_NE(lines[i].text, lines[1].text);
}

}  // namespace
}  // namespace liloc::wire
