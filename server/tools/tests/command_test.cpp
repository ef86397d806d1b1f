#include "server/tools/command.hpp"

#include <gtest/gtest.h>

namespace liloc::toolbox {
namespace {

TEST(Complain, IsOneLineOfTheProgramsOwnAndGivesTheCodeBack) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(complain(Error{"site.json: cut\noff \x1b[2J; write it anew"}, kBadUsage), 2);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "liloc: site.json: cut off ?[2J; write it anew\n");
}

TEST(ProgressBar, IsSilentWhereNobodyLooksOn) {
  testing::internal::CaptureStderr();
  {
    ProgressBar bar("replay");
    for (const double share : {0.0, 0.5, 1.0, 7.0}) bar.show(share);
  }
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(Commands, EachAddsItselfWithHelp) {
  CLI::App app;
  int exit_code = 0;
  add_align(app, exit_code);
  add_calibrate(app, exit_code);
  add_convert(app, exit_code);
  add_doctor(app, exit_code);
  add_explain(app, exit_code);
  add_record(app, exit_code);
  for (const char* name : {"align", "calibrate", "convert", "doctor", "explain", "record"}) {
    const CLI::App* command = app.get_subcommand(name);
    EXPECT_FALSE(command->get_description().empty()) << name;
    EXPECT_NE(command->help().find("Usage"), std::string::npos) << name;
  }
}

}  // namespace
}  // namespace liloc::toolbox
