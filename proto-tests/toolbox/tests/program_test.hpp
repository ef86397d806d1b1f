#pragma once
// The program `liloc` as a user runs it, in a folder of the test's own.
#include <gmock/gmock.h>

#include <algorithm>
#include <string>

#include "common/testing/program.hpp"
#include "proto-tests/replay/tests/temp_folder.hpp"

namespace liloc::toolbox {

class ProgramTest : public testing::Test {
 protected:
  [[nodiscard]] std::string path(const std::string& name) const { return (folder_.path() / name).string(); }
  [[nodiscard]] static Outcome liloc(const std::string& arguments) {
    return run_program(LILOC_PROGRAM, arguments);
  }
  /// One line of the program's own, which holds `part`.
  static void expect_complaint(const Outcome& outcome, int exit_code, const std::string& part) {
    EXPECT_EQ(outcome.exit_code, exit_code) << outcome.out;
    EXPECT_EQ(std::ranges::count(outcome.out, '\n'), 1) << outcome.out;
    EXPECT_THAT(outcome.out, testing::StartsWith("liloc: "));
    EXPECT_THAT(outcome.out, testing::HasSubstr(part));
  }
  /// Bad usage: exit code 2, and `out` of the folder is not made.
  void expect_refused(const std::string& arguments, const std::string& part, const std::string& out) const {
    expect_complaint(liloc(arguments), 2, part);
    EXPECT_FALSE(std::filesystem::exists(path(out))) << arguments;
  }

  replay::TempFolder folder_;
};

}  // namespace liloc::toolbox
