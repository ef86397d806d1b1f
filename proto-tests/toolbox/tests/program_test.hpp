#pragma once
// The program `liloc` as a user runs it, in a folder of the test's own.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <unistd.h>

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
  /// With `disk` of the folder a file system of so many kilobytes; what is left on it then lies in `left`.
  /// Where the system permits no such, no file may have over 4 kB, and `disk` stays.
  [[nodiscard]] Outcome on_full_disk(int kilobytes, const std::string& arguments) const {
    std::filesystem::create_directories(path("disk"));
    const std::string own = geteuid() == 0 ? "-m" : "-rm";
    const std::string mount = fmt::format("mount -t tmpfs -o size={}k tmpfs {}", kilobytes, path("disk"));
    const std::string run = fmt::format(LILOC_PROGRAM " {}; code=$?; cp -a {} {}; exit $code", arguments,
                                        path("disk"), path("left"));
    if (run_program("unshare", fmt::format("{} sh -c '{}'", own, mount)).exit_code == 0)
      return run_program("unshare", fmt::format("{} sh -c '{} && {}'", own, mount, "{ " + run + "; }"));
    return run_program("sh", fmt::format("-c 'trap \"\" XFSZ; ulimit -f 8; {}'", run));
  }
  /// Exit code 1, not that of bad usage, one line that names a file on the disk and the cause.
  static void expect_told_as_full(const Outcome& outcome) {
    EXPECT_EQ(outcome.exit_code, 1) << outcome.out;
    EXPECT_THAT(outcome.out, testing::ContainsRegex("liloc: /[^ ]*/disk/[^ ]*: "));
    EXPECT_THAT(outcome.out, testing::AnyOf(testing::HasSubstr("No space left on device"),
                                            testing::HasSubstr("File too large")));
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
