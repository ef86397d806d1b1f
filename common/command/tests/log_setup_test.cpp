#include "common/command/log_setup.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace liloc::command {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;
using testing::Not;

/// What three lines of the log leave on standard error.
std::string printed(const std::string& program, LineFormat format) {
  testing::internal::CaptureStderr();
  log::set_sink(stderr_sink(program, log::Level::info, std::move(format)));
  log::debug("too fine");
  log::info("it runs");
  log::error("it {}", "fell");
  log::set_sink({});
  return testing::internal::GetCapturedStderr();
}

TEST(LogSetup, TellsTimeLevelAndTextOfWhatIsNotTooFine) {
  const std::string text = printed("plain", {});
  EXPECT_THAT(text, ContainsRegex("^[0-9-]{10} [0-9:.]{12} info it runs\n"));
  EXPECT_THAT(text, HasSubstr("error it fell\n"));
  EXPECT_THAT(text, Not(HasSubstr("fine")));
}

TEST(LogSetup, AFormatOfItsOwnIsTheWholeLine) {
  const std::string text = printed("own", [](log::Level level, std::string_view line) {
    return fmt::format("{}|{}", static_cast<int>(level), line);
  });
  EXPECT_EQ(text, "1|it runs\n3|it fell\n");
}

}  // namespace
}  // namespace liloc::command
