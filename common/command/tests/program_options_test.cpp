#include "common/command/program_options.hpp"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

#include "common/command/checks.hpp"

namespace liloc::command {
namespace {

using testing::AllOf;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
namespace fs = std::filesystem;

class Program : public testing::Test {
 protected:
  Program() {
    app_.set_version_flag("--version", "1");
    app_.add_option("--site", site_)->required();
    auto* group = app_.add_option_group("method");
    group->add_option("--voxel", voxel_)->check(in_range(0.01, 0.5));
    group->add_option("--rotation", rotation_)->expected(4)->check(finite());
    app_.add_option("--peer", peers_);
    app_.add_flag("--ros", ros_);
  }
  ~Program() override { fs::remove(file_); }

  /// The error after parsing `text` as the file and these arguments; empty: none.
  std::string parse(const std::string& text, std::vector<const char*> arguments = {}) {
    std::ofstream(file_, std::ios::binary) << text;
    arguments.insert(arguments.begin(), {"prog", "--config", file_.c_str()});
    const Status parsed = options_.parse(static_cast<int>(arguments.size()), arguments.data(), exit_code_);
    return parsed ? "" : parsed.error().message;
  }

  const fs::path file_ =
      fs::temp_directory_path() / ("liloc_program_options_" + std::to_string(getpid()) + ".toml");
  std::string site_;
  double voxel_ = 0.1;
  std::vector<double> rotation_;
  std::vector<std::string> peers_;
  bool ros_ = false;
  CLI::App app_{"", "prog"};
  ProgramOptions options_{app_};
  int exit_code_ = -1;
};

TEST_F(Program, ReadsAFileAndTheCommandLineWins) {
  ASSERT_EQ(parse("site = 'a'\nvoxel = 0.2\npeer = ['x', 'y']\nros = true\nrotation = [0, 0, 0, 1]\n",
                  {"--site", "b"}),
            "");
  EXPECT_EQ(exit_code_, 0);
  EXPECT_EQ(site_, "b");
  EXPECT_DOUBLE_EQ(voxel_, 0.2);
  EXPECT_THAT(peers_, testing::ElementsAre("x", "y"));
  EXPECT_TRUE(ros_);
  EXPECT_EQ(rotation_.size(), 4U);
  EXPECT_THAT(options_.located({"--voxel is odd"}).message, EndsWith(".toml: line 2: voxel is odd"));
  EXPECT_EQ(options_.located({"--site is odd"}).message, "--site is odd");  // as the command line has it
}

TEST_F(Program, OneNameIsEnoughForAList) {
  ASSERT_EQ(parse("\xef\xbb\xbfsite = 'a'\npeer = 'x'\nros = false\n"), "");
  EXPECT_THAT(peers_, testing::ElementsAre("x"));
  EXPECT_FALSE(ros_);
}

struct Wrong {
  const char* text;
  const char* says;
};

class WrongFile : public Program, public testing::WithParamInterface<Wrong> {};

TEST_P(WrongFile, IsNamedWithLineKeyAndRemedy) {
  const std::string error = parse(std::string("site = 'a'\n") + GetParam().text);
  EXPECT_EQ(exit_code_, 2);
  EXPECT_THAT(error, AllOf(HasSubstr(".toml: line 2: "), HasSubstr(GetParam().says), Not(HasSubstr("\n"))));
}

INSTANTIATE_TEST_SUITE_P(
    Files, WrongFile,
    testing::Values(Wrong{"voxle = 0.1", "there is no option voxle; is it voxel?"},
                    Wrong{"colour = 1", "there is no option colour"}, Wrong{"[method]\nvoxel = 0.1", "section"},
                    Wrong{"voxel 0.1", "name = value"},
                    Wrong{"voxel = nan", "voxel: is 'nan'; give a number in 0.01..0.5"},
                    Wrong{"voxel = 1e999", "voxel: is '1e999'"}, Wrong{"voxel = -inf", "voxel: is '-inf'"},
                    Wrong{"voxel = 'wide'", "voxel: is 'wide'"},
                    Wrong{"voxel = [0.1]", "voxel takes one value"},
                    Wrong{"rotation = [0, 0, 1]", "rotation has 3 values; give 4"},
                    Wrong{"rotation = [0, 0, 0, nan]", "rotation: is 'nan'"},
                    Wrong{"ros = 'maybe'", "ros is a switch"}, Wrong{"ros = 2", "ros is a switch"},
                    Wrong{"config = 'b'", "no option config"}, Wrong{"help = true", "no option help"},
                    Wrong{"version = true", "no option version"}, Wrong{"peer = []", "peer has 0 values"}));

TEST_F(Program, HostileTextIsNotEchoed) {
  const std::string error = parse("site = 'a'\n" + std::string(500'000, 'k') + " = 1\n");
  EXPECT_LT(error.size(), 300U);
  EXPECT_THAT(error, HasSubstr("line 2"));
}

TEST_F(Program, WhatIsNotAFileIsRefusedAtOnce) {
  const auto with = [&](const std::string& path) {
    const char* arguments[] = {"prog", "--site", "a", "--config", path.c_str()};
    const Status parsed = options_.parse(5, arguments, exit_code_);
    return parsed ? std::string() : parsed.error().message;
  };
  EXPECT_THAT(with("no/such.toml"), AllOf(HasSubstr("--config"), HasSubstr("no such file")));
  EXPECT_THAT(with(fs::temp_directory_path().string()), HasSubstr("no regular file"));
  ASSERT_EQ(mkfifo(file_.c_str(), 0600), 0);
  EXPECT_THAT(with(file_.string()), HasSubstr("no regular file"));
  EXPECT_EQ(exit_code_, 2);
}

TEST_F(Program, UnknownArgumentsAreListedInTheirOrder) {
  const std::string error = parse("site = 'a'\n", {"--one", "--two"});
  EXPECT_EQ(error, "not expected: '--one' '--two'; see prog --help");
  EXPECT_EQ(exit_code_, 2);
}

TEST_F(Program, WhatIsMissingIsNamed) {
  EXPECT_EQ(parse(""), "--site is required; see prog --help");
}

}  // namespace
}  // namespace liloc::command
